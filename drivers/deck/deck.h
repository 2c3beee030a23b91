/* SPDX-License-Identifier: BSD-3-Clause */
/* What a deck means: from a file to lattice, obstacles and options. Syntax is namelist.c's business, the table of keys
 * schema.c's. */
#ifndef DEM_DECK_H
#define DEM_DECK_H

#include <dem/trajectory.h>

#include "body.h"
#include "deck_slabs.h"
#include "lattice_facts.h"
#include "schema.h"
#include "setting.h"

typedef enum deck_status {
    DECK_OK,
    DECK_UNREADABLE, /* not a regular file of 1 byte to 4 MiB that can be read */
    DECK_INVALID,    /* has the faults listed */
    DECK_MEMORY      /* memory ran out */
} deck_status;

/* Everything is owned by the deck. */
typedef struct deck {
    char *path, *source; /* the file's name and text */
    char *folder;        /* where it lies, with the last '/', or "" */
    schema_deck groups;  /* as resolved */
    /* What follows from the values of keys. */
    char *title, *name;
    double t_end;    /* s */
    double residual; /* > 0: a quasi-static run ends there */
    int stop_at_overlap;
    double closure;          /* share of the energy from which on the log warns */
    dem_options options;     /* 0, of the window < 0, where the library is to choose; with its arrays once built */
    double frame_interval;   /* s */
    double history_interval; /* s between rows of the history, at least; 0: every step has one; < 0: looks.h chooses */
    int double_precision, deflate, events, breaks, fragments;
    uint32_t fields;         /* DEM_FIELD_... */
    dem_index peak_every;    /* accepted steps between looks at peaks; 0: none; < 0: looks.h chooses */
    dem_index most_stressed; /* that are listed */
    bool measure;            /* constants and frequencies for the log */
    /* What deck_build() makes. */
    char *echo, *physics; /* resolved: every key, paths absolute; only those that make the problem */
    char *course;         /* resolved: what a run that goes on from another must have in common with it */
    uint64_t hash;       /* FNV-1a of `physics`, in which files of bodies stand as hashes of their bytes: the problem */
    uint64_t run_hash;   /* the same with every key: the run */
    deck_slabs slabs;    /* that are made in place of: */
    dem_lattice lattice; /* all bodies, in the order of the deck */
    lattice_facts facts; /* of it */
    body_facts *bodies;  /* [n_bodies], one for each group */
    size_t n_bodies;
    dem_obstacle *obstacles; /* [n_obstacles] */
    dem_index n_obstacles;
    dem_boundary *boundaries; /* [n_boundaries] */
    dem_index n_boundaries;
    double *body_friction;     /* of each body; NULL: the options' */
    dem_probe *probes;         /* [n_probes] */
    double (*probe_places)[2]; /* [n_probes] m, at rest */
    dem_index n_probes;
} deck;

/* Reads the file, puts `settings`, [n], in it and checks its groups: faults of syntax, of keys and of their meaning are
 * reported together, sorted by place; a file that is unreadable has its message at 0:0, a fault of settings[k] is at
 * line -1 - k. Nothing is built yet. *out is empty unless DECK_OK is returned. */
deck_status deck_parse(deck *out, const char *path, const setting *settings, size_t n, namelist_errors *errors);

/* Builds what a deck that was parsed describes, in slabs where d->slabs.n is not 0, if it can be; what is wrong with
 * the geometry is reported for all bodies. To be called once. *d is empty unless DECK_OK is returned. */
deck_status deck_build(deck *d, namelist_errors *errors);

void deck_free(deck *d);

#endif
