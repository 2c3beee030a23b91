/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/trajectory.h -- a run as one HDF5 file that ParaView opens (VTKHDF), and lattices from such files.
 *
 *  A trajectory is an observer: create it, hand dem_trajectory_observer() to the simulation, advance, finish. A run
 *  that is to survive being killed calls dem_trajectory_segment() before it writes a checkpoint to disk; the next one
 *  begins with dem_trajectory_resume() from that checkpoint, and what it finishes is, dataset by dataset, what one run
 *  would have made.
 *  Threads may write and read files of their own at the same time: they take turns, call by call.
 *  docs/output.md lists every dataset. HDF5 is confined to the source files behind this header. */
#ifndef DEM_TRAJECTORY_H
#define DEM_TRAJECTORY_H

#include <dem/dem.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dem_trajectory dem_trajectory;

/** Arrays of the frames, beside the positions. */
enum {
    DEM_FIELD_DISPLACEMENT = 1,
    DEM_FIELD_VELOCITY = 2,
    DEM_FIELD_STRESS = 4,     /**< of the nodes: dem_simulation_stress() */
    DEM_FIELD_VON_MISES = 8,  /**< dem_stress_von_mises() */
    DEM_FIELD_PRINCIPAL = 16, /**< both principal stresses */
    DEM_FIELD_STRAIN = 32,    /**< of the springs */
    DEM_FIELD_FORCE = 64,
    DEM_FIELD_CONTACT = 128,  /**< dem_simulation_contact_forces() and _pressures() */
    DEM_FIELD_FRAGMENT = 256, /**< dem_simulation_fragments() */
    DEM_FIELD_DAMAGE = 512,   /**< of the nodes: dem_simulation_damage() */
    DEM_FIELD_ALL = 1023
};

typedef enum dem_probe_kind {
    DEM_PROBE_NODE,   /**< t, x, v, stress, von_mises */
    DEM_PROBE_SPRING, /**< t, strain, force */
    DEM_PROBE_GAUGE   /**< t, length, strain of the distance between two nodes */
} dem_probe_kind;

/** What is recorded over time in the table /probes/NAME, at t = 0 and at every `every`-th accepted step. */
typedef struct dem_probe {
    const char *name; /**< 1 to 63 letters, digits, _ and -; of no other probe */
    dem_probe_kind kind;
    dem_index number[2]; /**< of the node or spring; of a gauge's two nodes, which are apart at rest */
    dem_index every;     /**< >= 1 */
} dem_probe;

typedef struct dem_trajectory_options {
    size_t struct_size;     /**< set by dem_trajectory_options_default() */
    double frame_interval;  /**< s between frames; <= 0: none, only the history */
    bool double_precision;  /**< false: displacement, velocity, strain, force in single precision; true: in double */
    int deflate;            /**< compression 0 (none) to 9; default 1 */
    bool events;            /**< true: the table /events of all contact events; default false */
    uint32_t fields;        /**< DEM_FIELD_... ORed; default all but DEM_FIELD_PRINCIPAL, _CONTACT, _FRAGMENT */
    const dem_peaks *peaks; /**< written by dem_trajectory_finish(), until when they are borrowed; default NULL: none */
    dem_index most_stressed; /**< nodes and springs of the peaks that are listed; default 5 */
    dem_index n_probes;      /**< default 0 */
    const dem_probe *probes; /**< [n_probes] copied */
    bool breaks;             /**< true: the table /breaks of all that breaks, and columns of /history; default false */
    bool fragments;          /**< true: the table /fragments, of each frame; default false */
    double history_interval; /**< s, at least, between rows of /history, which are accepted steps; default 0: each is */
    bool stays_open; /**< true: the part is whole in the file system after every frame, but stays open in this process,
                          where nothing else opens it then; takes half the time of a small frame; default false */
    int writers; /**< more than 1: arrays of frames are in so many files beside each file, which other ranks write of a
                      run that rank 0 leads (dem_batch --writers), of which there are as many at least; the simulation
                      then outlives the trajectory. What has the name of one and was not begun by a run of this
                      lattice stays, and is DEM_ERROR_IO at the start. Default 0, as 1: they are in the file itself */
} dem_trajectory_options;

static inline dem_trajectory_options dem_trajectory_options_default(void)
{
    dem_trajectory_options options;
    memset(&options, 0, sizeof options); /* C++ warns of = {0} */
    options.struct_size = sizeof options;
    options.deflate = 1;
    options.most_stressed = 5;
    options.fields = DEM_FIELD_ALL & ~(DEM_FIELD_PRINCIPAL | DEM_FIELD_CONTACT | DEM_FIELD_FRAGMENT | DEM_FIELD_DAMAGE);
    return options;
}

/** Whether an accepted step at `t` has a row of /history: at every instant it is but once, and with an interval only
 *  where a multiple of that lies behind the row before and not behind `t`.
 *  \param interval  s, as dem_trajectory_options.history_interval
 *  \param before    s, of the row before; -INFINITY: there is none */
DEM_API bool dem_history_row_due(double interval, double before, double t);

/** Starts `path`, which must end in ".vtkhdf". Until dem_trajectory_finish() the file is NAME.part.vtkhdf, closed
 *  after every frame (but see stays_open) so that it can be looked at while the run goes on. As many threads deflate
 *  it as the simulation has (dem_options.threads), to the same bytes.
 *  Writes the lattice group, the obstacle file NAME.obstacle.vtkhdf (none without obstacles) and NAME.body.vtkhdf, by
 *  which ParaView shows triangles (none without triangles or frames).
 *  The run starts anew: an older part is overwritten, and segments NAME.00001.vtkhdf, ... of an unfinished run are
 *  removed, from which only dem_trajectory_resume() goes on. A file of such a name that is no segment stays; it stops
 *  dem_trajectory_segment() when that comes to it. */
DEM_API dem_status dem_trajectory_create(dem_trajectory **out, const char *path, const dem_simulation *simulation,
                                         const dem_trajectory_options *options);

/** Goes on with the trajectory of a run that was killed or stopped, or that is to be continued: the counterpart of
 *  dem_trajectory_create(), with the same path and options (deflate, most_stressed and peaks may be others). The
 *  segments must hold just the rows up to the checkpoint: younger ones are removed, as is the part. Where there are no
 *  such segments, but a finished NAME.vtkhdf that has these rows, they become the first segment; NAME.vtkhdf stays.
 *  Notes are not read back.
 *  \param checkpoint  one that dem_trajectory_segment() was called with; only read
 *  \return DEM_ERROR_IO with the segment that is missing or another run's, DEM_ERROR_ARGUMENT with the option that
 *          differs; then nothing has changed */
DEM_API dem_status dem_trajectory_resume(dem_trajectory **out, const char *path, const dem_simulation *simulation,
                                         const dem_trajectory_options *options, const dem_checkpoint *checkpoint);

/** The observer to hand to dem_simulation_observe(); borrows the trajectory. Its entries in a checkpoint are
 *  "trajectory" and "trajectory.probes". */
DEM_API dem_status dem_trajectory_observer(dem_trajectory *trajectory, dem_observer *out);

/** Stores a string in /provenance under `name`, in the part and in every file that is made from now on. */
DEM_API dem_status dem_trajectory_note(dem_trajectory *trajectory, const char *name, const char *text);

/** Publishes what was seen up to the checkpoint, and is in no segment yet, as the next segment, a file of its own that
 *  is synced and read back; what is later stays in the part. A checkpoint that is written to disk after this loses no
 *  row.
 *  \param checkpoint  of this run, not older than that of the segment before
 *  \return DEM_ERROR_IO, then the files are as they were */
DEM_API dem_status dem_trajectory_segment(dem_trajectory *trajectory, const dem_checkpoint *checkpoint);

/** Writes what is buffered, and the peaks, syncs, and gives the file its final name, replacing a file of that name:
 *  that is the part, or a new file of all segments and the part, which then are removed. */
DEM_API dem_status dem_trajectory_finish(dem_trajectory *trajectory);

/** Accepts NULL. Without a finish before it the part file stays as of its last frame. */
DEM_API void dem_trajectory_destroy(dem_trajectory *trajectory);

/** Reads back a string of /provenance into `text`, terminated.
 *  \return DEM_ERROR_IO if the file or the string is not there, DEM_ERROR_ARGUMENT if `size` is too small */
DEM_API dem_status dem_trajectory_read_note(const char *path, const char *name, char *text, size_t size);

/** Reads the group /lattice of any HDF5 file into a new lattice: every output file carries one. docs/output.md lists
 *  its datasets; any other name in it is refused. Numbers may have any width and byte order, integers do for reals, and
 *  `fixed` may be boolean as h5py stores it; a number that does not fit is an error. Types, ranks and extents are
 *  checked before anything is allocated; external and soft links, external and virtual storage, and filters other than
 *  deflate, shuffle and fletcher32 are refused.
 *  \param[out] out  from dem_lattice_empty(); overwritten, not freed; caller owns it
 *  \return DEM_ERROR_IO with the file, dataset and reason; DEM_ERROR_MODEL for inconsistent extents */
DEM_API dem_status dem_lattice_read(dem_lattice *out, const char *path);

/** How large the lattice of such a file is: the same checks, but for those of its numbers, which are not read.
 *  \return as dem_lattice_read() */
DEM_API dem_status dem_lattice_measure(const char *path, dem_index *n_nodes, dem_index *n_springs);

/** Reads what a slab (dem/slab.h) has of the group /lattice, by the checks of dem_lattice_read(). The nodes of the file
 *  are n_parts ranges, each of as many nodes as the others, or one more; the own nodes of the slab are number `part` of
 *  these. It has their springs and triangles, and all arrays that the file has, of its rim too: it is assembled, and
 *  fit for dem_model_create_mpi_slab(). Where the file has no list of contact nodes these are known of own nodes only;
 *  it has no rim_boundary.
 *  All springs and triangles of the file are looked at, 65536 at a time, or a chunk of a dataset whose deflated chunks
 *  are larger; besides that memory is taken for the slab, and a list of its nodes, springs and triangles.
 *  Each rank reads its slab by itself. Where that fails on some, all can go on to dem_model_create_mpi_slab(), which
 *  fails on all if a slab is empty.
 *  \param[out] out  from dem_slab_empty(); overwritten, not freed; caller owns it
 *  \param part      0 <= part < n_parts
 *  \return as dem_lattice_read(), but numbers that the slab does not have are not looked at, except those of nodes;
 *          DEM_ERROR_MODEL also for more parts than nodes, and, on all ranks, where springs or triangles are not in
 *          ascending order of their lowest nodes, with the first one: a model of slabs numbers them in that order. All
 *          lattices that this library makes have it, but for triangles of meshes by Gmsh */
DEM_API dem_status dem_slab_read(dem_slab *out, const char *path, dem_index part, dem_index n_parts);

/** For a program that uses HDF5 through this library only, as its first call of it: HDF5 then does not clean up at the
 *  exit of the process, where version 1.10 crashes if a file could not be written or closed. By then all are closed. */
DEM_API void dem_hdf5_skip_exit(void);

/** Version of the HDF5 library in use, "MAJOR.MINOR.PATCH". */
DEM_API const char *dem_version_hdf5(void);

#ifdef __cplusplus
}
#endif

#endif
