#pragma once
// The subroutine UMAT of Abaqus/Standard as a law behind talus_law.h.
#include <cstddef>

#include "materials/interface/own_law.hpp"
#include "materials/interface/own_law_code.hpp"

namespace talus {

/// The arguments of UMAT in their order, with the length of CMNAME behind them, as gfortran passes it.
using UmatFunction = void (*)(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double* rpl,
                              double* ddsddt, double* drplde, double* drpldt, const double* stran, const double* dstran, const double* time,
                              const double* dtime, const double* temp, const double* dtemp, const double* predef, const double* dpred,
                              const char* cmname, const int* ndi, const int* nshr, const int* ntens, const int* nstatv, const double* props,
                              const int* nprops, const double* coords, const double* drot, double* pnewdt, const double* celent,
                              const double* dfgrd0, const double* dfgrd1, const int* noel, const int* npt, const int* layer,
                              const int* kspt, const int* kstep, const int* kinc, std::size_t cmname_length);

/// The law of a subroutine with its constants.  Throws Error.
std::shared_ptr<const OwnLawCode> umat_code(UmatFunction umat, const UmatLaw& law, OwnLawOrigin origin);

}  // namespace talus
