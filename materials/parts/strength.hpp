#pragma once
// Shear strength divided by a factor: strength reduction, triggers.

#include "core/types.hpp"

namespace talus {

/// A law that has shear strength; the others are elastic, or flow under any shear.
template <class L>
concept HasStrength = requires(L law, Real factor)
{
  law.divide_strength(factor);
};

/// Divides the shear strength of a law by `factor` > 0; what its particles remember stays.  False, and no change, if the law has none.
template <class L>
bool divide_strength(L& law, Real factor) noexcept
{
  if constexpr (HasStrength<L>)
    law.divide_strength(factor);
  return HasStrength<L>;
}

}  // namespace talus
