#pragma once
// Facets of one cell alone lie on the boundary of a mesh, edges of one facet alone on the rim of a surface.
#include <algorithm>
#include <cstddef>
#include <vector>

namespace talus {

/// Those that stand in the list once, ascending.
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
