/* A subroutine UMAT of Abaqus in C: von Mises plasticity without hardening.  PROPS: Young's modulus, Poisson's ratio, yield stress; STATEV(1):
 * plastic strain. */
#include <math.h>
#include <stddef.h>

void umat_(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double* rpl, double* ddsddt, double* drplde,
           double* drpldt, const double* stran, const double* dstran, const double* time, const double* dtime, const double* temp,
           const double* dtemp, const double* predef, const double* dpred, const char* cmname, const int* ndi, const int* nshr,
           const int* ntens, const int* nstatv, const double* props, const int* nprops, const double* coords, const double* drot,
           double* pnewdt, const double* celent, const double* dfgrd0, const double* dfgrd1, const int* noel, const int* npt,
           const int* layer, const int* kspt, const int* kstep, const int* kinc, size_t cmname_length)
{
  const double E = props[0], nu = props[1], yield = props[2];
  const double mu = E / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu);
  const double volume = dstran[0] + dstran[1] + dstran[2];
  double mean = 0, square = 0;
  for (int i = 0; i < *ntens; ++i) {
    stress[i] += i < *ndi ? lambda * volume + 2 * mu * dstran[i] : mu * dstran[i]; /* engineering shear strains */
    for (int j = 0; j < *ntens; ++j)
      ddsdde[j * *ntens + i] = (i == j ? (i < *ndi ? 2 * mu : mu) : 0) + (i < *ndi && j < *ndi ? lambda : 0);
  }
  for (int i = 0; i < *ndi; ++i)
    mean += stress[i] / 3;
  for (int i = 0; i < *ntens; ++i)
    square += i < *ndi ? (stress[i] - mean) * (stress[i] - mean) : 2 * stress[i] * stress[i];
  const double mises = sqrt(1.5 * square);
  if (mises <= yield)
    return;
  const double ratio = yield / mises, slip = (mises - yield) / (3 * mu);
  for (int i = 0; i < *ntens; ++i)
    stress[i] = i < *ndi ? mean + ratio * (stress[i] - mean) : ratio * stress[i];
  statev[0] += slip;
  *spd += yield * slip;
}
