/* SPDX-License-Identifier: BSD-3-Clause */
/* What is run: the decks of a folder, and random scenes. Each case goes to store_check(). */
#ifndef DEM_TEST_CASES_H
#define DEM_TEST_CASES_H

/** Each deck by three integrators and both methods of contact, with every kernel. */
void cases_decks(const char *folder);

/** Each deck by both methods of contact, written to a file that is read back. */
void cases_files(const char *folder);

/** 20 scenes by both methods of contact, with every kernel: run through, and resumed half-way. Fails if what scenes are
 *  there for, friction and vertices and the like, does not occur in them. */
void cases_scenes(void);

#endif
