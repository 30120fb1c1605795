// Enters: the image of a guided integrator after 4, 8, 16 ... passes, and some of its pixels as path tracing sees them.
// Leaves: whether plain path tracing needs less time to equal error, so that it does the rest, or gives it back; from
//   what merges, guided-bdpt does the rest, and is looked at in turn.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ajar/film/film.h"
#include "ajar/render/adaptive.h"
#include "ajar/render/ledger.h"

namespace ajar {

/// Radiance of the pixels of squares of plain_side x plain_side pixels, one after another: sums over passes, and over
/// even ones of them.
struct PassHalves {
  uint32_t passes = 0;  ///< even
  std::vector<glm::dvec3> sum, half;
};
inline constexpr int plain_side = 8;
inline constexpr uint32_t plain_pixels = plain_side * plain_side;

/// relMSE of images exposed to a mean of a fifth.
struct PlainLook {
  double guided = 0;     ///< of the guided image, from the difference of its halves, without the worst 0.1 % of pixels
  double plain = 0;      ///< of path tracing's
  double deviation = 0;  ///< standard deviation of that
  double missed = 0;     ///< of what path tracing has not seen and the guided image has, at least
  double bias = 0;       ///< by which whole squares of the guided image differ from path tracing's, beyond noise
};
PlainLook compare_halves(const PassHalves& guided, const PassHalves& plain);
/// What path tracing has not seen, as PlainLook::missed. Where the guided integrator merges, its blur makes many
/// squares too bright, which is not path tracing's fault.
double missed_by_plain(const PlainLook& look, bool merges);

/// An image that is set aside, with what was counted of it.
struct SetAside {
  Film film;  ///< empty: there is none
  Ledger ledger;
};

/// Path tracing beside a guided integrator: squares spread over the film, in as much time as the guided passes of their
/// pixels took. (L2)
struct Plain {
  bool taken = false;       ///< path tracing does the rest of the passes
  bool settled = false;     ///< it is not looked at again
  uint32_t passes = 0;      ///< of the image when it was last looked at
  double ratio = 0;         ///< its error over the guided integrator's after equal time, then; 0: not known
  double pace = 1;          ///< samples of it in the time of one, then
  double guided_error = 0;  ///< relMSE of a sample, then
  double plain_error = 0;   ///< the same of path tracing, with what it has not seen
  double missed = 0;        ///< the greatest PlainLook::missed of a sample, halved from look to look
  uint64_t rays = 0;        ///< that it took
  PassHalves seen;
  SetAside guided;        ///< the image when path tracing took over, while it may still be given back
  Adaptive adaptive;      ///< of that image, too
  uint32_t returned = 0;  ///< passes of path tracing that were dropped when it was
  uint32_t merged = 0;    ///< passes after which merging was left out; 0: it was not
  SetAside with_merging;  ///< the image with it, while the one without has fewer passes
};

}  // namespace ajar
