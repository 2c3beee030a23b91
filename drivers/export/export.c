/* SPDX-License-Identifier: BSD-3-Clause */
#include "export.h"

#include <stdarg.h>
#include <string.h>

#include "csv.h"
#include "lammps.h"
#include "vtu.h"

static const char usage[] =
    "usage: dem_export RUN.vtkhdf --to lammps|vtu|csv [OPTION]...\n"
    "       dem_export --version | --help\n"
    "formats:\n"
    "  lammps  NAME.data, in.NAME, NAME.dump and NAME.local.dump, for LAMMPS, OVITO and MDAnalysis\n"
    "  vtu     NAME.pvd, NAME_0000.vtu, ... and NAME.obstacle.vtu or .pvd, for ParaView of any version\n"
    "  csv     NAME.nodes.csv, NAME.springs.csv, NAME.history.csv, NAME.breaks.csv, ..., a file for each table\n"
    "options:\n"
    "  --to lammps|vtu|csv  the format\n"
    "  -o NAME              what the names of files begin with; a folder, or FOLDER/: the run's name in it (default: "
    "the "
    "run's\n"
    "                       name, here)\n"
    "  --frames LIST        0,5,10 or 0:20:5; -1 is the last (default: all)\n"
    "  --overwrite          replace files that are there\n"
    "  --version            print the version\n"
    "  --help               print this\n"
    "exit codes: 0 done, 2 usage, 3 not in the run, 5 input or output, 6 out of memory, 7 a file is there already\n";

void export_help(FILE *out)
{
    (void)fputs(usage, out);
}

__attribute__((format(printf, 1, 2))) static bool refuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)fprintf(stderr, "dem_export: error: ");
    (void)vfprintf(stderr, format, arguments);
    (void)fprintf(stderr, "\n");
    va_end(arguments);
    return false;
}

static const struct {
    const char *word;
    bool (*write)(const task *t);
} formats[] = {{"lammps", lammps_export}, {"vtu", vtu_export}, {"csv", csv_export}};

/* ---- options with a value, which is not NULL ---- */

static bool parse_format(export *e, const char *text)
{
    for (size_t k = 0; k < sizeof formats / sizeof *formats; k++)
        if (strcmp(text, formats[k].word) == 0) return e->write = formats[k].write, true;
    return refuse("'--to' needs lammps, vtu or csv, got '%s'", text);
}

static bool parse_output(export *e, const char *text)
{
    e->output = text;
    return true;
}

static bool parse_frames(export *e, const char *text)
{
    e->frames = text;
    return true;
}

static const struct {
    const char *word, *what;
    bool (*parse)(export *e, const char *value);
} options[] = {
    {"--to", "lammps, vtu or csv", parse_format}, {"-o", "a name", parse_output}, {"--frames", "a list", parse_frames}};

/* ---- words ---- */

static bool parse_word(export *e, const char *word)
{
    if (strcmp(word, "--help") == 0) return e->action = EXPORT_HELP, true;
    if (strcmp(word, "--version") == 0) return e->action = EXPORT_VERSION, true;
    if (strcmp(word, "--overwrite") == 0) return e->overwrite = true;
    if (word[0] == '-' || word[0] == '\0') return refuse("'%s' is no option: dem_export --help", word);
    if (e->input != NULL) return refuse("one run at a time: '%s' and '%s'", e->input, word);
    e->input = word;
    return true;
}

static bool parse_all(export *e, char **argv)
{
    const size_t n = sizeof options / sizeof *options;
    for (char **word = argv; *word != NULL; word++) {
        size_t k = 0;
        while (k < n && strcmp(*word, options[k].word) != 0) k++;
        if (k < n && (word[1] == NULL || word[1][0] == '\0')) return refuse("'%s' needs %s", *word, options[k].what);
        if (!(k < n ? options[k].parse(e, *++word) : parse_word(e, *word))) return false;
    }
    if (e->action != EXPORT_FILES) return true;
    if (e->input == NULL) return refuse("no run: dem_export --help");
    return e->write != NULL || refuse("to what? --to lammps, vtu or csv");
}

exit_code export_parse(export *out, char **argv)
{
    *out = (export){0};
    return parse_all(out, argv) ? EXIT_DONE : EXIT_USAGE;
}
