#pragma once
// The number of members of an aggregate, to check that a hand-written list of them is complete.
#include <cstddef>
#include <utility>

namespace talus {

namespace detail {

struct ConvertibleToAny {
  template <class T>
  operator T() const;  // only named, never called
};

template <class T, std::size_t... I>
constexpr bool takes(std::index_sequence<I...>)
{
  return requires { T{((void)I, ConvertibleToAny{})...}; };
}

}  // namespace detail

/// The number of members of the aggregate T, which must not have base classes or arrays as members.
template <class T, std::size_t N = 0>
constexpr std::size_t member_count()
{
  if constexpr (detail::takes<T>(std::make_index_sequence<N + 1>{}))
    return member_count<T, N + 1>();
  else
    return N;
}

}  // namespace talus
