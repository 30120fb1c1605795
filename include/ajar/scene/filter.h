// Enters: the name and parameters of a reconstruction filter.
// Leaves: its separable kernel, normalised to integral 1, to evaluate and to sample.
#pragma once

#include <optional>
#include <vector>

#include "ajar/core/vec.h"

namespace ajar {

enum class FilterKind : uint8_t { box, tent, gaussian, mitchell, catmullrom, lanczos };

/// Separable pixel filter. Camera samples are drawn from |kernel| and carry its sign (filter importance sampling, Ernst
/// et al. 2006); splats are weighted by the kernel. box and tent are exact. The other kernels *are* their fine table,
/// linear between its entries (within 1e-4 of the formula), so that sampling is the exact inverse of evaluation.
struct Filter {
  FilterKind kind = FilterKind::tent;
  float radius = 1;          ///< pixels
  float a = 0, b = 0;        ///< gaussian: stddev; mitchell: B, C; lanczos: lobes
  std::vector<float> table;  ///< kernel at equal steps over [-radius, radius]; empty for box and tent; by make_filter
  std::vector<float> cdf;    ///< of |table|, at the same places, 0 .. 1
  float sign_norm = 1;       ///< integral of |kernel| over integral of kernel
};

/// Builds a filter; radius 0 takes the kind's usual one (box 0.5, tent 1, gaussian 4 stddev = 2, the others 2; lanczos
/// its lobes); without a or b the usual parameters (gaussian stddev 0.5; mitchell B = C = 1/3; lanczos 3 lobes). Throws
/// Error for a radius or a stddev that is not from 0.05 to 16 pixels, lobes not from 1 to 16, B or C not from -4 to 4.
Filter make_filter(FilterKind kind, float radius = 0, std::optional<float> a = {}, std::optional<float> b = {});
/// Kernel at a signed distance in pixels, normalised so that its integral is 1.
float eval(const Filter& filter, float x);
/// Draws an offset from the pixel's centre for u in [0,1)^2; weight is +-sign_norm^2, 1 for positive filters.
Vec2 sample(const Filter& filter, const Vec2& u, float& weight);

}  // namespace ajar
