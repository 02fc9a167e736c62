/* Drucker-Prager with elastic strain increments: yield sqrt(J2) + q p = k with the mean stress p, flow without change of volume, tension up to
 * the tip of the cone, linear loss of cohesion. */
#include <math.h>
#include <stdio.h>

#include "talus_law.h"

enum { youngs_modulus, poisson_ratio, friction_angle, cohesion, residual_cohesion, softening_strain };
static const talus_law_parameter parameters[] = {
    {"youngs_modulus", "Pa", "Young's modulus", NAN, 1, INFINITY},
    {"poisson_ratio", "-", "Poisson's ratio", 0.3, -0.99, 0.4999},
    {"friction_angle", "deg", "angle of friction in triaxial compression", NAN, 0, 80},
    {"cohesion", "Pa", "cohesion in triaxial compression", NAN, 0, INFINITY},
    {"residual_cohesion", "Pa", "cohesion after softening; below 0: there is none", -1, -1, INFINITY},
    {"softening_strain", "-", "plastic strain at which it is reached", 1, 1e-6, INFINITY},
};

enum { plastic_strain, plastic_work };
static const talus_law_variable variables[] = {
    {"plastic_strain", "-", "accumulated deviatoric plastic strain", 1, 0, 0},
    {"plastic_work", "J/m^3", "dissipated energy", 1, 0, 0},
};

enum { lambda, mu, bulk, q, k_peak, k_residual, n_constants };

static int begin(talus_law_setup* setup)
{
  const double *in = setup->parameters, nu = in[poisson_ratio];
  const double phi = in[friction_angle] * acos(-1) / 180, cone = 6 / (sqrt(3) * (3 - sin(phi)));
  double* out = setup->constants;
  if (in[residual_cohesion] > in[cohesion]) {
    snprintf(setup->message, setup->message_size, "residual_cohesion %g Pa is above cohesion %g Pa", in[residual_cohesion], in[cohesion]);
    return 1;
  }
  setup->bulk = out[bulk] = in[youngs_modulus] / (3 * (1 - 2 * nu));
  setup->shear = out[mu] = in[youngs_modulus] / (2 * (1 + nu));
  out[lambda] = out[bulk] - 2 * out[mu] / 3;
  out[q] = cone * sin(phi);
  out[k_peak] = cone * in[cohesion] * cos(phi);
  out[k_residual] = in[residual_cohesion] < 0 ? out[k_peak] : cone * in[residual_cohesion] * cos(phi);
  return 0;
}

static int update(talus_law_block* block)
{
  const double *c = block->constants, soft = block->parameters[softening_strain];
  const ptrdiff_t stride = block->stride;
  for (int p = 0; p < block->n; ++p) {
    double s[6], *history = block->history + p;
    const double volume = block->strain[p] + block->strain[stride + p] + block->strain[2 * stride + p];
    for (int i = 0; i < 6; ++i)
      s[i] = block->stress[i * stride + p] + 2 * c[mu] * block->strain[i * stride + p] + (i < 3 ? c[lambda] * volume : 0);
    double mean = (s[0] + s[1] + s[2]) / 3;
    for (int i = 0; i < 3; ++i)
      s[i] -= mean;
    const double tau = sqrt(0.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) + s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
    const double lost = fmin(history[plastic_strain * stride] / soft, 1);
    const double k = c[k_peak] + lost * (c[k_residual] - c[k_peak]);
    if (!block->elastic && c[q] * mean > k)
      mean = k / c[q]; /* it opens */
    const double strength = fmax(k - c[q] * mean, 0);
    double ratio = 1;
    if (!block->elastic && tau > strength) {
      const double slip = (tau - strength) / c[mu]; /* engineering shear strain */
      ratio = strength / tau;
      history[plastic_strain * stride] += slip / sqrt(3);
      history[plastic_work * stride] += strength * slip;
    }
    for (int i = 0; i < 6; ++i)
      block->stress[i * stride + p] = ratio * s[i] + (i < 3 ? mean : 0);
  }
  return 0;
}

static int weaken(void* context, double factor, double* values)
{
  const double degree = acos(-1) / 180;
  (void)context;
  values[friction_angle] = atan(tan(values[friction_angle] * degree) / factor) / degree;
  values[cohesion] /= factor;
  if (values[residual_cohesion] > 0)
    values[residual_cohesion] /= factor;
  return 0;
}

static const talus_law law = {
    .version = TALUS_LAW_VERSION,
    .measure = TALUS_LAW_STRAIN,
    .name = "soil",
    .summary = "Drucker-Prager cone through triaxial compression, in rate form.",
    .n_parameters = sizeof parameters / sizeof *parameters,
    .parameters = parameters,
    .n_variables = 2,
    .variables = variables,
    .n_constants = n_constants,
    .begin = begin,
    .update = update,
    .weaken = weaken,
};

const talus_law* soil(void) { return &law; }
