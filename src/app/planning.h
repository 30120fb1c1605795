// Enters: a plan.
// Leaves: the same for people and for machines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ajar/render/plan.h"

namespace ajar {

/// Lines: what the pilot showed, parts, what will be rendered with.
std::string describe(const Plan& plan);
nlohmann::ordered_json to_json(const Plan& plan);

}  // namespace ajar
