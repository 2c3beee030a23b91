/* SPDX-License-Identifier: BSD-3-Clause */
/* Strengths and critical stretches that scatter, drawn for a body and for each of its copies. */
#ifndef DEM_STRENGTHS_H
#define DEM_STRENGTHS_H

#include <dem/dem.h>

/* Of what a material has: less is not drawn. Elements as weak as that would break under loads of no interest. */
#define STRENGTHS_LEAST 0.2

/* How a body draws. */
typedef struct strengths_rule {
    dem_weibull *laws; /* [n_laws]; their numbers of bodies are set here */
    dem_index n_laws;
    const dem_index *of; /* [n_triangles] number of each triangle's law */
    size_t body;         /* from 0, its &body in the deck */
    size_t n_copies;     /* itself included */
} strengths_rule;

/* What was drawn for the triangles, or for the springs, of all copies. */
typedef struct strengths_range {
    dem_index n;        /* of one copy */
    dem_index n_raised; /* that drew less than STRENGTHS_LEAST, and have as much */
    double least, most; /* Pa, or a strain */
} strengths_range;

typedef struct strengths {
    strengths_range triangles, springs; /* without numbers: these do not scatter */
    double *of_triangles, *of_springs;  /* [n_copies][n] Pa, and strains, where there are copies; owned */
    double *softening;                  /* [n_copies][n_triangles] where they soften; owned */
    double *compressive;                /* [n_copies][n_triangles] Pa, where pressure breaks them; owned */
} strengths;

/* Draws for a lattice that has the strengths of its materials and is not placed yet, and gives it those of the first
 * copy. Free with strengths_free().
 * \return a status of dem_lattice_weibull() */
dem_status strengths_draw(strengths *out, dem_lattice *lattice, const strengths_rule *rule);
void strengths_free(strengths *s);

/* Gives a lattice those of copy `number`, from 0; nothing where none scatter. */
void strengths_put(dem_lattice *lattice, const strengths *s, size_t number);

#endif
