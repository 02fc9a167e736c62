/* A material law of your own as a shared library that Talus opens.  C99 and C++; no other header of Talus is needed.
 *
 *   cc -O2 -shared -fPIC -I DIRECTORY_OF_THIS_FILE my_law.c -o libmy_law.so -lm
 *
 * The library has one function for each law.  It returns the description of the law, which stays valid:
 *
 *   const talus_law* my_law(void);
 *
 * A scene names file and function:   law: own, library: libmy_law.so, symbol: my_law, parameters: {stiffness: 1e7}
 *
 * Units are SI.  Stress is Cauchy stress, tension positive, without the pressure of pore water.  Symmetric tensors have the components xx, yy,
 * zz, xy, yz, xz; shear strains are those of the tensor, half of the engineering ones.  Other tensors have nine, row by row: xx, xy, xz, yx,
 * yy, yz, zx, zy, zz.  Everything has three dimensions, also in plane strain.
 *
 * Arrays of a block: component c of particle p stands at array[c * stride + p], so that a loop over the particles reads what lies side by side
 * and the compiler can take several at a time.
 *
 * Functions are called from several threads at once, for different blocks: they must not write to global or static variables.  The key `serial:
 * true` of a scene calls one at a time.  Talus repeats steps on copies of the history, so that a result must depend on the arguments alone.
 */
#ifndef TALUS_LAW_H
#define TALUS_LAW_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of this interface.  Write it into talus_law.version; Talus refuses a library that was compiled with another one. */
#define TALUS_LAW_VERSION 1

/* What a law starts from; see talus_law_block. */
enum {
  TALUS_LAW_STRAIN = 1,     /* the strain increment, and the old stress turned with the material */
  TALUS_LAW_DEFORMATION = 2 /* the deformation gradients before and after the step */
};

/* talus_law.flags, joined by | */
enum {
  TALUS_LAW_ISOCHORIC = 1, /* plastic flow keeps the volume: bodies average their volume (f_bar) unless the scene says otherwise */
  TALUS_LAW_FLUID = 2      /* at rest it bears pressure alone */
};

/* A parameter, a number that the scene gives. */
typedef struct talus_law_parameter {
  const char* key;     /* name in the scene */
  const char* unit;    /* "-" if it has none */
  const char* meaning; /* a few words, for messages */
  double value;        /* where the scene does not give it; NAN: the scene has to */
  double low, high;    /* smallest and largest value; INFINITY where there is no limit, both 0: no limits */
} talus_law_parameter;

/* A history variable: what each particle remembers from step to step.  It can be written out by its name and is kept in checkpoints.  A
 * variable with the key "plastic_work", in J per m^3 of initial volume, is counted in the energy balance as dissipated; "plastic_strain" is
 * the strain that static stages and factors of safety look at. */
typedef struct talus_law_variable {
  const char* key;
  const char* unit;
  const char* meaning;
  int components; /* 1, or 6: a symmetric tensor */
  int turns;      /* nonzero, of a tensor in a law of TALUS_LAW_STRAIN: Talus turns it with the material before each call, like the stress */
  double start;   /* of every component */
} talus_law_variable;

/* What begin() is asked for one material, once before the run.  Zero where nothing else is said. */
typedef struct talus_law_setup {
  void* context;            /* that of the law */
  const double* parameters; /* in the order of the description, within their limits */
  double density;           /* at rest [kg/m^3], from the scene */
  double* constants;        /* out: talus_law.n_constants numbers that update() needs and that follow from the parameters alone */
  double* history;          /* in: the start values; out: the history of a particle at rest, its variables one after the other */
  double bulk, shear;       /* out: elastic moduli at rest [Pa], the largest if they vary; they bound the first step */
  double viscosity;         /* out: largest viscosity [Pa s]; it bounds the step */
  char* message;            /* out: why the parameters do not fit together, in words, where begin() returns another value than 0 */
  size_t message_size;      /* room there, with the final 0 */
} talus_law_setup;

/* Particles to be updated, and the step. */
typedef struct talus_law_block {
  int32_t n;         /* number of particles */
  int32_t dimension; /* 2: plane strain, 3 */
  int32_t elastic;   /* nonzero in a stage that suspends yielding: answer elastically, leave hardening variables alone */
  int32_t failed;    /* out, with another result than 0: a particle that has no answer, 0 to n - 1; before the call -1 */
  ptrdiff_t stride;  /* of all arrays */
  double time, dt;   /* at the end of the step, and its length [s]; dt can be 0 */
  double density;    /* at rest [kg/m^3] */
  void* context;
  const double *parameters, *constants;

  const int64_t* id;      /* of each particle; -1 for one that is driven alone, as by talus drive */
  const double* position; /* 3 components, at the end of the step [m]; 0 for a particle that is driven alone */
  const double* size;     /* least altitude of the cell of the particle [m]; 0 where there is none */
  const double *F_old, *F; /* 9: deformation gradient before and after the step, of the stress-free start; with f_bar that of the averaged volume */
  const double* L;         /* 9: velocity gradient of the step [1/s], F = (I + dt L) F_old */
  const double* rotation;  /* 9: R of the polar decomposition I + dt L = V R; NULL unless the law is one of TALUS_LAW_STRAIN */
  const double* strain;    /* 6: ln V, the logarithmic strain increment, in the axes of the end of the step; NULL as above */

  double* stress;  /* 6, in: before the step [Pa], in a law of TALUS_LAW_STRAIN turned with the material, R s R^T; out: after it */
  double* history; /* in: before the step; out: after it */
  double *bulk, *shear; /* in: moduli at rest; out, where they change: the largest moduli of stress over strain increment after the step [Pa].
                           Their wave speed, sqrt((bulk + 4/3 shear) / (density / det F)), bounds the next step. */

  char* message; /* out: what went wrong, in words, with another result than 0 */
  size_t message_size;
} talus_law_block;

/* A law.  Functions return 0; any other value is an error, which ends the run with the message (see `message` above). */
typedef struct talus_law {
  int32_t version; /* TALUS_LAW_VERSION */
  int32_t measure; /* TALUS_LAW_STRAIN or TALUS_LAW_DEFORMATION */
  int32_t flags;
  int32_t n_constants;
  const char* name;
  const char* summary; /* one sentence */
  int32_t n_parameters, n_variables;
  const talus_law_parameter* parameters;
  const talus_law_variable* variables;
  void* context; /* passed to every function; it must not change in a run */

  /* Needed.  Moduli at rest, constants, and rules between parameters. */
  int (*begin)(talus_law_setup* setup);
  /* Needed.  Stress and history of all particles of the block.  A particle without an answer gets NAN as its stress; a message about it is
   * welcome (`failed`, `message`, result 1), after all others have been updated.  C++: an exception is caught and reported, and then no
   * particle of the block has an answer. */
  int (*update)(talus_law_block* block);
  /* NULL, or sets the history for which `stress` (6) is the stress of undeformed material: initial_stress.  A law of TALUS_LAW_STRAIN can start
   * from a stress without it; its history is then that at rest.  The history holds variables one after the other. */
  int (*prestress)(void* context, const double* parameters, const double* constants, const double* stress, double* history);
  /* NULL, or changes the parameters to those of a material whose shear strength is divided by the factor: talus fos, `weaken` in stages. */
  int (*weaken)(void* context, double factor, double* parameters);
} talus_law;

#ifdef __cplusplus
}
#endif

#endif
