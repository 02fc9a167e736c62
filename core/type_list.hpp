#pragma once
// A fixed list of types, and loops over it.
#include <type_traits>
#include <variant>

namespace talus {

template <class... T>
struct TypeList {
  static constexpr std::size_t size = sizeof...(T);
};

/// Calls f.template operator()<T>() for every T of the list, in order.
template <class... T, class F>
constexpr void for_each_type(TypeList<T...>, F&& f)
{
  (f.template operator()<T>(), ...);
}

/// The concatenation of lists.
template <class... T>
constexpr TypeList<T...> joined(TypeList<T...>)
{
  return {};
}
template <class... T, class... U, class... Rest>
constexpr auto joined(TypeList<T...>, TypeList<U...>, Rest... rest)
{
  return joined(TypeList<T..., U...>{}, rest...);
}

namespace detail {
template <class List, template <class> class Wrap>
struct VariantOf;
template <class... T, template <class> class Wrap>
struct VariantOf<TypeList<T...>, Wrap> {
  using type = std::variant<Wrap<T>...>;
};
}  // namespace detail

/// std::variant<Wrap<T>...>: one alternative per type of the list.
template <class List, template <class> class Wrap>
using variant_of = typename detail::VariantOf<List, Wrap>::type;

}  // namespace talus
