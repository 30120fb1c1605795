// Enters: a shape element.
// Leaves: its faces in parts, each with the bsdf that it is made of.
#pragma once

#include <functional>

#include "loader.h"

namespace ajar {

struct Part {
  std::string name;                             ///< what usemtl calls it; empty for the rest
  const Node* bsdf = nullptr;                   ///< none: the default
  std::function<bool(std::string_view)> takes;  ///< MeshOptions::takes_material; not set where the part is the whole
};

/// Of an obj with several bsdfs, one part for each name and one for the rest; one part of any other shape.
std::vector<Part> parts_of(Params& p);

/// The material of a part: its bsdf, or what shapes without one have.
uint32_t material_of(Params& p, const Part& part, bool emits);

}  // namespace ajar
