#include "io/document/document_json.hpp"

#include <nlohmann/json.hpp>

#include "io/document/scalars.hpp"

namespace talus {

namespace {

using DocumentJson = nlohmann::ordered_json;

DocumentJson scalar_json(const Node& value)
{
  if (Index whole{}; !read_scalar(value, Asked{}, whole))
    return whole;
  if (Real number{}; !read_scalar(value, Asked{}, number))
    return number;
  if (bool yes{}; !read_scalar(value, Asked{}, yes))
    return yes;
  return value.text;
}

DocumentJson json_of(const Node& value)
{
  switch (value.kind) {
    case Node::Kind::scalar: return scalar_json(value);
    case Node::Kind::list: {
      DocumentJson list = DocumentJson::array();
      for (const Node& item : value.items)
        list.push_back(json_of(item));
      return list;
    }
    case Node::Kind::mapping: {
      DocumentJson mapping = DocumentJson::object();
      for (std::size_t i = 0; i < value.keys.size(); ++i)
        mapping[value.keys[i].text] = json_of(value.items[i]);
      return mapping;
    }
    default: return {};
  }
}

}  // namespace

std::string in_json(const Node& value) { return json_of(value).dump(-1, ' ', false, DocumentJson::error_handler_t::replace); }

}  // namespace talus
