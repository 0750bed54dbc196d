#ifndef DETP_H
#define DETP_H

/* detp for C, and for all languages that can call C: plans a search for rays and discs, and executes it again and again.
 *
 * Every function returns a status. If it is not DETP_OK, `error`, unless null, has a message that names what is wrong, with the number of
 * a bad element; results are then untouched, except that of a stopped search. No function throws, and there are no globals: calls
 * on different handles may run on different threads at once; a plan may be executed by many threads, each with its own scratch.
 *
 * The caller owns all arrays. Rays and discs may be floats or doubles, with any stride; they must stay as they are during the call, which
 * reads rays in pieces: at most 16 MiB are copied at a time; a plan keeps 56 bytes a disc. A handle belongs to the caller, too: its free function takes the
 * address of the variable, and sets it to null, so that freeing it twice does nothing, and using it afterwards is an error, not a crash. Null handles are refused. Functions that make a handle
 * overwrite the variable.
 *
 * Structs begin with their size: set `size = sizeof(...)`, and all else to 0 but what you need; DETP_INIT does so. A newer library then
 * knows what an older caller does not have, and an older one refuses what it does not know.
 *
 * Units: lengths and positions in any one unit; powers in any unit; irradiance is power over that length squared; times in seconds. */

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define DETP_API __attribute__((visibility("default")))
#else
#define DETP_API
#endif

/* detp_plan_options options = DETP_INIT(detp_plan_options); */
#ifdef __cplusplus
template <class T>
inline T detp_with_size() {
  T all = T();
  all.size = sizeof(T);
  return all;
}
#define DETP_INIT(type) detp_with_size<type>()
extern "C" {
#else
#define DETP_INIT(type) \
  (type) { .size = sizeof(type) }
#endif

typedef enum detp_status {
  DETP_OK = 0,
  DETP_INVALID = 1,   /* a value, an array or a handle is wrong */
  DETP_NO_MEMORY = 2, /* the work does not fit in memory, or its numbers are beyond what can be counted */
  DETP_STOPPED = 3,   /* a progress function asked for it */
  DETP_FILE = 4,      /* a file cannot be read or written */
  DETP_INTERNAL = 5   /* a mistake in detp */
} detp_status;

typedef struct detp_error {
  char text[512]; /* UTF-8, ends with a 0 */
} detp_error;

typedef enum detp_type { DETP_FLOAT = 0, DETP_DOUBLE = 1 } detp_type;

/* Elements of three numbers. With y and z null, x has the three numbers of an element one after another; else x, y and z are arrays of
 * the coordinates. stride: bytes from one element to the next; 0: without gaps. */
typedef struct detp_vectors {
  const void *x, *y, *z;
  size_t stride;
  int type; /* DETP_FLOAT or DETP_DOUBLE */
} detp_vectors;

/* A number for each element; with `data` null, the number `of_all`. */
typedef struct detp_numbers {
  const void *data;
  size_t stride; /* bytes; 0: without gaps */
  int type; /* DETP_FLOAT or DETP_DOUBLE */
  double of_all;
} detp_numbers;

/* Directions may have any length except 0. lengths: how far a ray reaches from its origin; with `data` null and of_all 0, or infinite: the
 * ray is a line, without ends both ways. powers: with `data` null and of_all 0: 1 for each ray. photons: the number of each ray's photon,
 * ascending, so that pieces of one path count as one in standard errors; null: each ray is a path of its own. A ray may carry powers in
 * up to 64 bands: those of band 0 are `powers`, those of the next are further_powers[0] to further_powers[further_bands - 1]. */
typedef struct detp_rays {
  size_t size;
  size_t count;
  detp_vectors origins, directions;
  detp_numbers lengths, powers;
  const uint64_t *photons;
  const detp_numbers *further_powers;
  size_t further_bands;
} detp_rays;

/* Normals may have any length except 0. radii > 0. */
typedef struct detp_discs {
  size_t size;
  size_t count;
  detp_vectors centres, normals;
  detp_numbers radii;
} detp_discs;

/* Numbers of operations, counted (whole numbers) or expected. model/vocabulary/counts.hpp says what each is. */
typedef struct detp_counts {
  double loaded, segments;              /* rays; those that end */
  double cull_tests, culls, listed;     /* tests of rays with spheres and boxes; lists made; rays in them */
  double visits, disc_tests, doubtful;  /* discs tested with a list; ray-disc tests; those repeated in double */
  double steps, nodes;                  /* cells and tree nodes that single rays visit */
  double references, placements, made, sorted; /* of building: references stored, insertions, nodes, discs sorted */
  double hits;
  double bytes_touched; /* memory of a first search, by the sizes of its arrays; expected, or 0 */
} detp_counts;

/* Called at least ten times a second during long work, perhaps from other threads, one call at a time. share: of the work, 0 to 1. Returns 0 to go on, else the
 * work stops at once. */
typedef int (*detp_progress)(void *user, const char *what, double share);

/* ---- what an operation costs ---- */

typedef struct detp_costs detp_costs; /* of each operation, in seconds; never changes */

/* Those of another machine: predicted seconds may be off by a factor of two. */
DETP_API detp_status detp_costs_built_in(detp_costs **costs, detp_error *error);
/* Those that `detp calibrate` stored for this machine; the built-in ones if there are none. */
DETP_API detp_status detp_costs_stored(detp_costs **costs, detp_error *error);
/* Measured now, in about so many seconds (> 0; 8 for good ones, at least some). store: for detp_costs_stored. */
DETP_API detp_status detp_costs_measured(double seconds, int store, detp_progress progress, void *user, detp_costs **costs,
                                         detp_error *error);
DETP_API void detp_costs_free(detp_costs **costs);

/* ---- plans ---- */

typedef struct detp_plan detp_plan; /* technique, parameters and index for some discs; its discs are copied */

typedef struct detp_plan_options {
  size_t size;
  const detp_costs *costs; /* null: the built-in ones */
  double rays;             /* number of rays of each search; 0: as many as are shown to the plan */
  double farthest;         /* most distance of a ray's origin from the centre of the discs; 0: 1000 times their extent */
  int front_facing;        /* not 0: only rays that arrive at a disc's front hit */
  int threads;             /* most threads, for planning and for each search; 0: all cores */
  int once;                /* not 0: the plan is executed once or twice, so that planning must be short */
  detp_progress progress;  /* may be null */
  void *user;              /* for `progress` */
} detp_plan_options;

/* Chooses technique and parameters by a pilot with the rays, which are some or all of those that will be searched, and builds the index.
 * options may be null. */
DETP_API detp_status detp_plan_create(const detp_discs *discs, const detp_rays *rays, const detp_plan_options *options,
                                      detp_plan **plan, detp_error *error);
/* The same samples with discs of another radius, all alike, and with `rays` rays in each search (0: as before): for progressive
 * estimation. Takes microseconds; the index is built by the first search. The new plan does not need the old one. */
DETP_API detp_status detp_plan_with_radius(const detp_plan *plan, double radius, double rays, detp_plan **changed,
                                           detp_error *error);
DETP_API void detp_plan_free(detp_plan **plan);

typedef struct detp_plan_facts {
  size_t size;
  const char *technique;  /* "box-tree"; valid as long as the plan */
  const char *parameters; /* JSON: {"fan_out":8,"leaf":16}; valid as long as the plan */
  size_t discs;
  int threads;              /* of a search */
  double predicted_seconds; /* of a search, building the index included */
  double predicted_error;   /* standard error of it; 0: not known */
  double planning_seconds;
  double predicted_seconds_again; /* of a repeated search, in the scratch of an earlier one */
  double prepare_seconds;         /* of predicted_seconds: sorting the discs and building the index */
  double peak_bytes;              /* predicted memory of rays, discs and a first search of them */
} detp_plan_facts;

DETP_API detp_status detp_plan_describe(const detp_plan *plan, detp_plan_facts *facts, detp_error *error);

/* ---- searches ---- */

typedef struct detp_scratch detp_scratch; /* memory of searches, and the pairs of the last one */

DETP_API detp_status detp_scratch_create(detp_scratch **scratch, detp_error *error);
DETP_API void detp_scratch_free(detp_scratch **scratch);

typedef struct detp_search_options {
  size_t size;
  int threads; /* 0: those of the plan */
  int pairs;   /* not 0: keep the pairs, for detp_pairs */
  int count;   /* not 0: count operations, which takes some time */
  detp_progress progress;
  void *user;
} detp_search_options;

/* What a search found. Arrays have an element for each disc, in the order of the plan's discs, or are null if they are not wanted. If the
 * rays have several bands, `bands` says how many (0: 1), and all arrays but the hits have a row of so many numbers for each disc. */
typedef struct detp_found {
  size_t size;
  uint64_t *hits;         /* rays that cross the disc */
  double *irradiance;     /* their power over the disc's area */
  double *standard_error; /* of the irradiance; infinite if fewer than two photons hit; weak (few photons bring most of it) where
                             the bound is more than 1.9 of it above the irradiance */
  double *upper_bound;    /* one-sided, 95 %, of the irradiance */
  /* set by the search: */
  uint64_t total_hits;
  double seconds;         /* of the search, the next two included */
  double reading_seconds; /* for reading and checking the rays */
  double build_seconds;   /* for what depends on the rays */
  detp_counts counts;     /* 0, but for the hits, unless options.count */
  int stopped;    /* not 0: hits and irradiance are those of a part of the rays */
  size_t bands;   /* to be set before the search */
} detp_found;

/* Finds every pair of a ray and a disc that it crosses, each once. The same rays and discs give the same bytes, with any technique and any
 * number of threads. options may be null. A search that was stopped returns DETP_STOPPED, and sets what it has. */
DETP_API detp_status detp_search(const detp_plan *plan, const detp_rays *rays, detp_scratch *scratch,
                                 const detp_search_options *options, detp_found *found, detp_error *error);

/* The pairs of the scratch's last search, which kept them, in compressed rows: the rays that cross disc i are rays[offsets[i]] to
 * rays[offsets[i + 1] - 1], ascending. offsets: one more than there are discs; rays: total_hits of them, room for `capacity`. */
DETP_API detp_status detp_pairs(const detp_scratch *scratch, uint64_t *offsets, uint32_t *rays, size_t capacity,
                                detp_error *error);

/* ---- searches until an error is reached ---- */

/* Makes the next rays, of whole photons, about `wanted` of them: sets what it needs of *rays (initialised, without rays), and *photons, the
 * photons emitted, with those that gave no ray (0: as many as rays; at least as many as the rays have photons). The irradiance of these rays times *scale (1) is that as if they were all
 * photons; *scale must be > 0 and finite. The arrays must stay until the next call, or until the search ends. Returns 0; 1 if there are no more rays; else the search is
 * stopped. Photons of different calls are independent. */
typedef int (*detp_next_rays)(void *user, uint64_t wanted, detp_rays *rays, double *photons, double *scale);

typedef struct detp_target {
  size_t size;
  double noise;      /* relative to the root mean square irradiance, over the discs by area: 0.05 */
  double confidence; /* that the noise of this run is smaller; 0: 0.95 */
  double most_rays;  /* 0: 10^9 */
  size_t noise_of;   /* of several bands: 0: of their sum; n: of band n - 1 */
} detp_target;

typedef enum detp_reason { DETP_REACHED = 0, DETP_NO_MORE_RAYS = 1, DETP_ENDED = 2 } detp_reason;

typedef struct detp_estimate {
  size_t size;
  double *irradiance; /* of each disc a number, or a row of one for each band; may be null */
  /* set by the search: */
  double noise, noise_low, noise_high; /* with the target's confidence, each end alone */
  double photons;
  uint64_t rays;
  int reason;         /* detp_reason */
  double share_bound; /* if no photon met any disc: at most this share of the photons meets one; else 0 */
  size_t bands;       /* of the rays, 0: 1; to be set before the search */
} detp_estimate;

/* Searches batches of rays until the noise is below the target. A search that `next` or `progress` stops has the estimate so far, with the reason
 * DETP_ENDED, if there was a batch, and returns DETP_STOPPED. */
DETP_API detp_status detp_search_until(const detp_plan *plan, detp_next_rays next, void *next_user, const detp_target *target,
                                       detp_progress progress, void *user, detp_estimate *estimate, detp_error *error);

/* ---- without rays ---- */

typedef struct detp_gather_options {
  size_t size;
  uint64_t paths;   /* that start at each sample, on each side that counts, and look for the lights; at most 2^32; 0: 64 */
  uint64_t seed;    /* of the paths */
  int front_facing; /* not 0: only light on the side of the normal counts */
  int threads;      /* 0: all cores */
  detp_progress progress;
  void *user;
  int rgb;          /* not 0: in red, green and blue, by the colours of the scene's materials */
} detp_gather_options;

/* Arrays have an element for each sample, with options.rgb all but the hits a row of three; or are null if they are not wanted. */
typedef struct detp_gathered {
  size_t size;
  uint64_t *hits;         /* paths that brought light */
  double *irradiance;     /* at the sample: not blurred, without bias */
  double *standard_error; /* of it; infinite if fewer than two paths brought light; weak where a few bring most of it */
  double *upper_bound;    /* one-sided, 95 %; infinite if no path of any sample brought light */
  /* set by the call: */
  double missed_share; /* of all light that lands on surfaces, what no backward path finds: that of points, spots and directional
                        * lights by way of mirrors, gloss or glass; the irradiance is without it; measured by some photons */
  double missed_bound; /* one-sided, 95 %, of that share; 0: all light is found */
  double seconds;      /* without reading the scene */
  int stopped;         /* not 0: samples that were not reached have 0 hits and irradiance 0 */
} detp_gathered;

/* The irradiance at samples in a scene: a mesh file, or a built-in one as "@cornell", with its own lights, or without any an area light.
 * The radii of the discs do not matter. The same bytes with any number of threads. options may be null. If it was stopped, returns
 * DETP_STOPPED, and sets what it has. */
DETP_API detp_status detp_gather(const char *scene, const detp_discs *discs, const detp_gather_options *options,
                                 detp_gathered *gathered, detp_error *error);

/* ---- without data ---- */

/* Rays and samples that are only known by their numbers: isotropic lines, uniform samples in a cube. */
typedef struct detp_workload {
  size_t size;
  double rays;
  double samples;
  double disc_radius;
  double scene_side; /* of the cube */
  double dimension;  /* 3: samples fill the cube; 2: they lie on its faces; 0: 3 */
} detp_workload;

/* The technique that closed forms choose: facts as of a plan; technique and parameters are written to `text`, which has room for `room`
 * bytes (200 suffice). costs may be null: the built-in ones. threads: at most; 0: all cores. */
DETP_API detp_status detp_choose(const detp_workload *workload, const detp_costs *costs, int threads, char *text,
                                 size_t room, detp_plan_facts *facts, detp_error *error);

/* One sphere of the sphere cache, S_i. */
typedef struct detp_sphere {
  double radius;       /* r_i = r_0 Q^i */
  double rays;         /* n_i: expected number of rays that cross it */
  double listed;       /* rays in its list */
  double rebuilds;     /* m_i */
  double rebuild_cost; /* t_i: ray-sphere tests of one rebuild */
} detp_sphere;

typedef struct detp_prediction {
  size_t size;
  detp_sphere *spheres; /* of a sphere cache: S_1, S_2 …; may be null */
  size_t room;          /* for so many spheres */
  /* set by the call: */
  uint64_t k;           /* number of spheres of the cache; as many are written as there is room for */
  detp_counts counts;
  double build_seconds;     /* sorting included */
  double rebuild_seconds;   /* T_R: making lists */
  double intersect_seconds; /* T_I: ray-disc tests, and recording hits */
  double seconds;           /* all of it, other phases included, on so many threads: */
  int threads;
} detp_prediction;

/* Closed forms of one technique on a workload. parameters: JSON, as in detp_plan_facts; those that are missing, or all if it is null,
 * become the best ones: {"ratio":0.65} gives Q and leaves k open; of "sphere-cache" with {}, Q is the best ratio. published: not 0: the
 * formulas as they were published (sphere-cache with ratio and spheres; k is theirs unless given), else the corrected ones.
 * The parameters that are taken are written to `text`, which has room for `room` bytes (200 suffice). costs may be null: the built-in
 * ones. threads: at most; 0: all cores. */
DETP_API detp_status detp_predict(const detp_workload *workload, const char *technique, const char *parameters,
                                  int published, const detp_costs *costs, int threads, char *text, size_t room,
                                  detp_prediction *prediction, detp_error *error);

/* ---- a run in a scene ---- */

/* What the command `detp run` has found. */
typedef struct detp_run detp_run;

typedef struct detp_run_view {
  size_t size;
  /* set by the call; the arrays belong to the run, and have an element for each disc: */
  size_t discs;
  const double *centres; /* x, y, z of each */
  const double *normals; /* x, y, z of each */
  const double *radii;
  const uint64_t *hits;
  const double *irradiance;
  const double *standard_error; /* null unless it was asked for, or the run ended at an error */
  const double *upper_bound;    /* one-sided, 95 %; null likewise */
  const char *json;             /* what the command prints */
  size_t bands;                 /* the last three arrays have a row of so many numbers for each disc */
  size_t triangles;             /* of the scene's mesh, if each of its vertices has a disc; else 0 */
  const uint32_t *corners;      /* the discs at the corners of each triangle */
} detp_run_view;

/* Does what `detp run WORDS...` does: makes discs and rays of a scene or of files, chooses technique and parameters, searches, and
 * stops at an error if the words ask for one. Takes --standard-error also without --per-disc. One value for each option. A run that
 * progress stopped is partial: its JSON says so. progress: as of detp_ask. */
DETP_API detp_status detp_run_create(const char *const *words, size_t count, detp_progress progress, void *user,
                                     detp_run **run, detp_error *error);
DETP_API detp_status detp_run_look(const detp_run *run, detp_run_view *view, detp_error *error);
DETP_API void detp_run_free(detp_run **run);

typedef enum detp_column_kind {
  DETP_REAL = 0, /* a double */
  DETP_COUNT,    /* a whole number from 0 on */
  DETP_INDEX     /* a whole number from -1 to 2^31 - 1 */
} detp_column_kind;

typedef struct detp_column {
  const char *name;
  const double *numbers; /* of each row */
  detp_column_kind kind;
} detp_column;

/* Writes rows of results, as `detp run --per-disc` does: CSV, PLY, VTK PolyData or NPY, by the path's suffix. Columns x, y, z are places, nx, ny, nz
 * normals. corners: rows at the corners of each triangle, in .ply and .vtp; null: points alone. */
DETP_API detp_status detp_results_write(const char *path, const detp_column *columns, size_t count, size_t rows,
                                        const uint32_t *corners, size_t triangles, detp_error *error);

/* ---- every other question ---- */

/* What the command `detp WORDS... --format json` prints: closed forms and the best Q (`model`), what accuracy costs (`accuracy`), runs that stop
 * at an error (`run ... --target-noise`), verdicts (`validate`), scenes. The text is to be freed. Nothing is printed; files are written only
 * where the words name them. progress can stop the work; its share is always 0. */
DETP_API detp_status detp_ask(const char *const *words, size_t count, detp_progress progress, void *user, char **json,
                              detp_error *error);
DETP_API void detp_text_free(char **text);

/* "0.1.0". */
DETP_API const char *detp_version(void);

#ifdef __cplusplus
}
#endif

#endif
