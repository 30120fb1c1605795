#include "ajar/render/options.h"

#include <fmt/format.h>

#include "ajar/core/error.h"
#include "ajar/core/parallel.h"

namespace ajar {
namespace {

// NaN is in no range.
template <class T>
void require(const char* name, T value, bool is_fine, const char* cure) {
  if (!is_fine) throw Error(fmt::format("options: {} is {}; {}", name, value, cure));
}

void check_learning(const LearnOptions& o) {
  require("learn.mix", o.mix, o.mix >= 0 && o.mix < 1, "give it 0 or more, below 1");
  require("learn.forget", o.forget, o.forget >= 0 && o.forget <= 1, "give it 0 to 1");
  require("learn.trust", o.trust, o.trust > 0, "give it more than 0");
  require("learn.divide_cell", o.divide_cell, o.divide_cell > 0, "give it more than 0");
  require("learn.divide_stratum", o.divide_stratum, o.divide_stratum > 0, "give it more than 0");
  require("learn.least_contrast", o.least_contrast, o.least_contrast >= 0, "give it 0 or more");
}

}  // namespace

void check(const RenderOptions& o) {
  require("seconds", o.seconds, o.seconds >= 0, "give it more than 0, or 0 for no limit");
  require("cpu_seconds", o.cpu_seconds, o.cpu_seconds >= 0, "give it more than 0, or 0 for no limit");
  require("noise", o.noise, o.noise >= 0, "give it a relMSE above 0, or 0 for no target");
  require("threads", o.threads, o.threads >= 0 && o.threads <= most_threads, "give it 1 to 4096, or 0 for all");
  require("max_depth", o.max_depth, o.max_depth == -1 || o.max_depth >= 1,
          "give it 1 or more edges, or -1 for no limit");
  require("roulette_depth", o.roulette_depth, o.roulette_depth >= 0, "give it 0 or more edges");
  const bool merges = o.integrator != "photon" || o.merge_radius > 0;
  require("merge_radius", o.merge_radius, o.merge_radius >= 0 && o.merge_radius < infinity && merges,
          "give it pixels, above 0 for photon; 0 merges nothing");
  require("final_gather", o.final_gather, o.final_gather >= 0, "give it rays, or 0 for none");
  check_learning(o.learn);
}

}  // namespace ajar
