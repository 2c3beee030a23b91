/* SPDX-License-Identifier: BSD-3-Clause */
#include "page.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "page_blocks.h"
#include "page_content.h"
#include "page_facts.h"
#include "page_plan.h"
#include "page_template.h"
#include "part_file.h"

static const double beside = 16384.0; /* bytes of a page that page_plan_fit() does not count one by one */

/* Texts of a page, each in a script of its own. */
typedef struct texts {
    char *notes, *summary, *content;
} texts;

static void texts_free(texts *t)
{
    free(t->notes);
    free(t->summary);
    free(t->content);
    *t = (texts){0};
}

static void put_text(const char *id, const char *text, FILE *out)
{
    (void)fprintf(out, "<script type=\"application/json\" id=\"%s\">", id);
    page_facts_write(text, out);
    (void)fputs("</script>\n", out);
}

static bool put_page(const page_content *p, const texts *t, FILE *out, outcome *o)
{
    (void)fputs(page_template_before, out);
    put_text("content", t->content, out);
    put_text("notes", t->notes, out);
    put_text("summary", t->summary, out);
    const bool good = page_blocks_write(p, out, o);
    (void)fputs(page_template_behind, out);
    return good;
}

static double bytes_of(FILE *out)
{
    return (double)ftell(out);
}

static bool write_file(const page_content *p, const texts *t, double *bytes, outcome *o)
{
    part_file file;
    if (!part_file_open(&file, p->asked->page, o)) return false;
    if (!put_page(p, t, file.file, o)) return part_file_drop(&file), false;
    errno = 0;
    const bool good = fflush(file.file) == 0 && ferror(file.file) == 0;
    *bytes = bytes_of(file.file);
    return part_file_close(&file, good, "an error of the device", o);
}

static void report(const page_content *p, double bytes, FILE *log)
{
    (void)fprintf(log, "%s: %.1f MB, %zu frame%s", p->asked->page, 1e-6 * bytes, p->frames.n,
                  p->frames.n == 1 ? "" : "s");
    if (p->frames.n < p->n_asked) (void)fprintf(log, " of %zu", p->n_asked);
    (void)fprintf(log, ", coloured by %zu quantit%s", p->n_quantities, p->n_quantities == 1 ? "y" : "ies");
    if (p->n_quantities < p->n_found) (void)fprintf(log, " of %zu", p->n_found);
    if (p->history != NULL) (void)fprintf(log, ", %zu rows of history", p->n_rows);
    if (p->history != NULL && p->n_rows < p->history->n) (void)fprintf(log, " of %zu", p->history->n);
    const bool is_whole = p->frames.n == p->n_asked && p->n_quantities == p->n_found &&
                          (p->history == NULL || p->n_rows == p->history->n);
    (void)fprintf(log, "%s\n", is_whole ? "" : ": the rest is beyond --max-size");
}

static bool make(page_content *p, texts *t, FILE *log, outcome *o)
{
    const char *path = p->asked->input;
    double bytes = 0.0;
    if (!page_facts_notes(path, &t->notes, o) || !page_facts_summary(path, &t->summary, o)) return false;
    const double fixed = beside + (double)strlen(page_template_before) + (double)strlen(page_template_behind) +
                         page_facts_length(t->notes) + page_facts_length(t->summary);
    if (!page_plan_fit(p, fixed, p->asked->max_size, o) || !page_content_survey(p, o)) return false;
    if (!page_facts_content(p, &t->content, o) || !write_file(p, t, &bytes, o)) return false;
    report(p, bytes, log);
    return true;
}

bool page_draw(const dem_reader *reader, const request *asked, FILE *log, outcome *o)
{
    page_content p;
    texts t = {0};
    const bool done = page_content_open(&p, reader, asked, o) && make(&p, &t, log, o);
    page_content_close(&p);
    texts_free(&t);
    return done;
}
