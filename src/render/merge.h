// Enters: light subpaths of a batch; camera subpaths.
// Leaves: the light vertices that are merged with, and what merges bring.
#pragma once

#include "job.h"

namespace ajar {

/// Beyond the first vertex at which a camera subpath is merged, it is merged with one light subpath in so many: those
/// merges share what found the vertex, and more of them do not help.
inline constexpr uint32_t inner_photons = 16;

/// Light vertices of a batch to merge with, at the first vertex at which a camera subpath is merged, and beyond it.
struct PhotonMaps {
  PhotonMap all, few;  ///< few: of one light subpath in inner_photons
};

/// Puts the light subpath's vertices among those that the batch merges with.
void keep_photons(const Job& job, const Sample& sample, Scratch& scratch);
/// s >= 2: all light vertices near the last vertex of the camera subpath.
void join_merged(const Job& job, Sample& sample, Scratch& scratch);

}  // namespace ajar
