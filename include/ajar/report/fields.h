// Enters: learned fields, and the scene that they belong to.
// Leaves: what was learned as lines of text, and pictures of it as the camera sees the scene.
#pragma once

#include <string>

#include "ajar/accel/accel.h"
#include "ajar/core/sampler.h"
#include "ajar/field/store.h"
#include "ajar/film/picture.h"

namespace ajar {

/// Cells and nodes by level, bytes, how far the strata are trusted, range of irradiance and importance: lines of text.
std::string describe(const StoredFields& stored);

/// Something known at every pixel in false colour. low and high: the values of the ramp's ends, 0 where there is none.
struct FalseColour {
  Picture picture;
  float low = 0, high = 0;
};

/// The first hit of every pixel of the crop window in the colour of its cell, any colour, the same for the same cell
/// (Dahm and Keller 2017, figure 7f). Grey: no cell.
Picture picture_cells(const Scene& scene, const Accel& accel, const Fields& fields);
/// Irradiance (camera) or importance (light) of the cell of every pixel's first hit, on a logarithmic scale from black
/// through blue, green and yellow to white (Comi, figure 4.6). Grey: no cell, or nothing known.
FalseColour picture_totals(const Scene& scene, const Accel& accel, const Fields& fields, Side side);
/// Hemispheres at first hits spread over the picture, over their places (Dahm and Keller 2017, figure 4): each is a
/// disk, seen from in front of its surface and upright to the camera; the same ramp, white the largest value of the
/// disk and black a thousandth of it.
Picture picture_strata(const Scene& scene, const Accel& accel, const Fields& fields, Side side);

}  // namespace ajar
