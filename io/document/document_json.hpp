#pragma once
// A document as JSON, for other programs.
#include <string>

#include "io/document/document.hpp"

namespace talus {

/// Numbers, true and false are those of JSON, also where the field takes text; a key without a value is null.
std::string in_json(const Node& value);

}  // namespace talus
