// Enters: hits along a subpath.
// Leaves: its vertices, compact, in storage that a thread keeps; what joining and MIS need is on the vertex.
#pragma once

#include <span>
#include <vector>

#include "ajar/field/guide.h"

namespace ajar {

/// A vertex a_i of a subpath. For both sides: "own" is the side that traced it, "before" the vertex nearer to that
/// side's end. Vertex 0 (the lens, the light's point) uses p, ng, beta, own, delta, infinite, seen (false), sum
/// and next_events (1) alone, of a light also error and point.
struct Vertex {
  Vec3 p{0};
  float error = 0;      ///< offset for rays that leave here
  Vec3 ng{0};           ///< geometric normal as the shape has it; zero for a point light
  float distance2 = 0;  ///< squared, to the vertex before
  Rgb beta{0};  ///< throughput that arrives here, divided by the densities up to here; vertex 0: emitted over density
  float back = 0;   ///< solid-angle density here of the direction back times this = area density at the vertex before
  double own = 0;   ///< area density of this vertex as its own side generated it (solid angle when infinite); 1 for the
                    ///< lens, the probability of its choice for a light without extent
  double sum = 0;   ///< S of the vertex *before* this one, prefix.h (R3); vertex 0: its own
  float merge = 0;  ///< merge_density here (walk.h), on the camera's side times what the merge counts for
  bool delta = false;       ///< the subpath went on from here by a delta event
  bool seen = false;        ///< by the lens, itself or by way of delta events; camera subpaths
  bool infinite = false;    ///< vertex 0: a direction rather than a place
  uint8_t next_events = 1;  ///< rays to lights from here, also where none was sent by chance; camera subpaths
  float received = 0;       ///< luminance of what next-event estimation (the lens) brought here, per area
  float emitted = 0;        ///< luminance of the light that the subpath ran into here, times its MIS weight
  uint32_t shape = none;
  Guide guide;
  LightPoint point;  ///< vertex 0 of a light subpath
};

/// How a subpath left the scene from its last vertex.
struct Escape {
  Vec3 d{0};
  float pdf = 0;       ///< solid-angle density of d; 0: it did not leave the scene
  float radiance = 0;  ///< luminance of infinite lights in this direction, times the MIS weights of hitting them
  float share = 0;     ///< luminance of the throughput over that which arrived at the last vertex
};

/// Vertices of one subpath; n of them are in use. The storage is kept from path to path, so that tracing does not
/// allocate.
struct Subpath {
  std::vector<Vertex> vertices = std::vector<Vertex>(32);
  int n = 0;
  double nee_ratio = 1;  ///< of a light subpath from its second vertex on: ratio_of_next_event for its start (walk.h)
  Escape escape;

  Vertex& add() {
    if (n == int(vertices.size())) vertices.resize(2 * vertices.size());
    return vertices[size_t(n++)];
  }
  Vertex& operator[](int i) { return vertices[size_t(i)]; }
  void clear() { n = 0, nee_ratio = 1, escape = {}; }
  /// The first so many.
  std::span<const Vertex> first(int count) const { return {vertices.data(), size_t(count)}; }
  const Vertex& operator[](int i) const { return vertices[size_t(i)]; }
};

}  // namespace ajar
