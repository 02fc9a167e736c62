/* Hooke's law for the Cauchy stress: the law linear_elastic of Talus, written against talus_law.h. */
#include <math.h>

#include "talus_law.h"

static const talus_law_parameter parameters[] = {
    {"youngs_modulus", "Pa", "Young's modulus", NAN, 1, INFINITY},
    {"poisson_ratio", "-", "Poisson's ratio", 0.3, -0.99, 0.4999},
};

static int begin(talus_law_setup* setup)
{
  const double E = setup->parameters[0], nu = setup->parameters[1];
  setup->bulk = E / (3 * (1 - 2 * nu));
  setup->shear = E / (2 * (1 + nu));
  setup->constants[0] = setup->bulk - 2 * setup->shear / 3; /* lambda */
  setup->constants[1] = setup->shear;
  return 0;
}

static int update(talus_law_block* block)
{
  const double lambda = block->constants[0], mu = block->constants[1];
  const ptrdiff_t stride = block->stride;
  for (int p = 0; p < block->n; ++p) {
    const double* e = block->strain + p;
    double* s = block->stress + p;
    const double pressure = lambda * (e[0] + e[stride] + e[2 * stride]);
    for (int k = 0; k < 6; ++k)
      s[k * stride] += 2 * mu * e[k * stride] + (k < 3 ? pressure : 0);
  }
  return 0;
}

static const talus_law law = {
    .version = TALUS_LAW_VERSION,
    .measure = TALUS_LAW_STRAIN,
    .name = "elastic",
    .summary = "Hooke's law for the Cauchy stress.",
    .n_parameters = 2,
    .parameters = parameters,
    .n_constants = 2,
    .begin = begin,
    .update = update,
};

const talus_law* elastic(void) { return &law; }
