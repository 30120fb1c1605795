// Enters: an integrator's name.
// Leaves: what is traced for it.
#pragma once

#include "job.h"

namespace ajar {

struct Integrator {
  const char* name = nullptr;
  Trace trace = nullptr;
  bool splats = false;  ///< light subpaths reach the film
  bool guided = false;
  Trace light_half = nullptr;  ///< what is traced before, of all samples of a chunk or batch
  bool merges = false;
  bool vpls = false;  ///< trains its fields by trace_bdpt first, if it is guided
};

/// Throws Error for an unknown one.
const Integrator& find_integrator(const std::string& name);

}  // namespace ajar
