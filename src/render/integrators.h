// Enters: an integrator's name.
// Leaves: what is traced for it.
#pragma once

#include "job.h"

namespace ajar {

void trace_path(const Job& job, Sample& sample, Scratch& scratch);
void trace_bdpt(const Job& job, Sample& sample, Scratch& scratch);
void trace_light(const Job& job, Sample& sample, Scratch& scratch);
void trace_vpl(const Job& job, Sample& sample, Scratch& scratch);
void trace_photon(const Job& job, Sample& sample, Scratch& scratch);
/// The light subpath of one sample, put into the chunk's store and among what is merged. trace_bdpt is the second half,
/// or trace_photon, which joins nothing.
void trace_light_half(const Job& job, Sample& sample, Scratch& scratch);

struct Integrator {
  const char* name = nullptr;
  Trace trace = nullptr;
  bool splats = false;  ///< light subpaths reach the film
  bool guided = false;
  Trace light_half = nullptr;  ///< what is traced before, of all samples of a chunk or batch
  bool merges = false;
  bool vpls = false;       ///< trains its fields by trace_bdpt first, if it is guided
  bool strategies = true;  ///< has several (s, t) to make images of
  bool weighs = true;      ///< strategies against each other
};

/// Throws Error for an unknown one.
const Integrator& find_integrator(const std::string& name);

}  // namespace ajar
