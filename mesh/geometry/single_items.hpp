#pragma once
// Items that occur once in a list: facets of one cell only are the boundary of a mesh, edges of one facet only the rim of a surface.
#include <algorithm>
#include <cstddef>
#include <vector>

namespace talus {

/// The items that occur exactly once, ascending.
template <class Item>
std::vector<Item> single_items(std::vector<Item> items)
{
  std::sort(items.begin(), items.end());
  std::vector<Item> single;
  for (std::size_t i = 0, end = 0; i < items.size(); i = end) {
    for (end = i + 1; end < items.size() && items[end] == items[i];)
      ++end;
    if (end == i + 1)
      single.push_back(items[i]);
  }
  return single;
}

}  // namespace talus
