#pragma once
// Laws of the user as a scene gives them: a library with the interface talus_law.h, or one with a UMAT of Abaqus.  They are alternatives of the key
// `law` like every other, but not in the list Laws: their parameters, histories and stresses are known when their library is open.
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields.hpp"
#include "core/named_numbers.hpp"
#include "core/type_list.hpp"
#include "materials/interface/constitutive_law.hpp"

namespace talus {

/// What laws of the user have in common.
struct LawInLibrary {
  Real density{};
  std::string library;
  bool serial = false;
  std::shared_ptr<const ConstitutiveLaw> opened{};  ///< set when the library is opened, see io/scene/law_libraries.hpp
};

/// The fields that every law of the user has.
template <class Law>
constexpr auto library_fields()
{
  return std::tuple{required<Law, Real>("density", &Law::density, positive, "kg/m^3", "mass density at rest"),
                    required<Law, std::string>("library", &Law::library, any, "-",
                                               "shared library with the law, or own: a file in Python (.py), relative to this file"),
                    optional<Law, bool>("serial", &Law::serial, any, "-",
                                        "the library is called by one thread at a time: for code that writes to global variables")};
}

/// A law behind talus_law.h.
struct LawBySymbol : LawInLibrary {
  static constexpr std::string_view name = "own";
  static constexpr std::string_view summary =
      "A law of your own: a shared library with the C interface talus_law.h, or a class in Python, which says what parameters and history "
      "it "
      "has.";
  std::string symbol;
  NamedNumbers parameters;
  static constexpr auto fields()
  {
    using Law = LawBySymbol;
    return std::tuple_cat(
        library_fields<Law>(),
        std::tuple{required("symbol", &Law::symbol, any, "-", "function of the library that returns the law, or class in Python"),
                   optional("parameters", &Law::parameters, any, "-", "parameters of the law by their names")});
  }
};

/// The subroutine UMAT of Abaqus/Standard behind the same interface.
struct UmatLaw : LawInLibrary {
  static constexpr std::string_view name = "umat";
  static constexpr std::string_view summary =
      "A law of your own: a shared library with the subroutine UMAT of Abaqus, in Fortran, C or C++; SDV of Abaqus are history variables "
      "sdv1, sdv2 and so on.";
  std::string symbol = "umat_", cmname = "MATERIAL";
  std::vector<Real> constants, initial_statev;
  Index depvar = 0;
  bool dissipation = false;
  std::optional<Real> bulk_modulus, shear_modulus;
  static constexpr auto fields()
  {
    using Law = UmatLaw;
    return std::tuple_cat(
        library_fields<Law>(),
        std::tuple{optional("symbol", &Law::symbol, any, "-", "name of the subroutine in the library"),
                   optional("cmname", &Law::cmname, any, "-", "name of the material that the subroutine gets, CMNAME"),
                   optional("constants", &Law::constants, any, "-", "PROPS, as after *USER MATERIAL"),
                   optional("depvar", &Law::depvar, within(0, 10000), "-", "NSTATV, number of STATEV"),
                   optional("initial_statev", &Law::initial_statev, any, "-", "STATEV at rest, all of them; default 0"),
                   optional("dissipation", &Law::dissipation, any, "-",
                            "the subroutine adds its plastic dissipation to SPD: it is then in plastic_work and in the energy balance"),
                   optional("bulk_modulus", &Law::bulk_modulus, positive, "Pa",
                            "largest elastic bulk modulus, for the time step; default from DDSDDE at rest"),
                   optional("shear_modulus", &Law::shear_modulus, non_negative, "Pa", "with bulk_modulus")});
  }
  /// Appends the violated rules between parameters.
  void check(std::vector<std::string>& problems) const;
};

using LawsInLibraries = TypeList<LawBySymbol, UmatLaw>;
template <class L>
inline constexpr bool is_in_library = std::is_base_of_v<LawInLibrary, L>;

}  // namespace talus
