// Enters: the densities of a whole path's vertices as both sides would have generated them.
// Leaves: the weights of all strategies, by multiplying out every density: slow, without prefix sums, in long double.
#pragma once

#include <vector>

namespace ajar::kit {

/// A vertex of a path, or a direction at infinity. Densities as End (join/mis.h) has them.
struct OracleVertex {
  long double light = 1, camera = 1;  ///< area density as generated from the light's side and from the camera's side
  bool delta = false;                 ///< the path goes on through this vertex by a delta event
  long double merge = 0;              ///< pi r^2 N; 0 where nothing is merged
};

/// x_0 on the light .. x_k on the lens; at least two vertices.
struct OraclePath {
  std::vector<OracleVertex> vertices;
  bool hittable = true;         ///< a ray from the camera's side can find x_0
  long double nee = 1;          ///< density of next-event estimation for x_0, in the measure of vertices[0].light
  long double light_paths = 1;  ///< light subpaths for each camera sample
  long double inner = 1;        ///< factor on the density of joins of two walked vertices
  long double seen = 1;         ///< the same where all between the camera's vertex and the lens are deltas
  long double merge_inner = 1;  ///< and of merges, but where all between the vertex and the lens are deltas
  long double first_seen = 1;   ///< of next-event estimation, where all between its vertex and the lens are deltas
  long double next_events = 1;  ///< what it counts for against s = 0 alone, without that factor
};

/// Density of each strategy, s = 0 .. k light vertices and k + 1 - s >= 1 camera vertices; 0 where it cannot make the
/// path. A light seen directly belongs to s = 0 alone. Then, k + 1 more, that of a merge at each vertex.
std::vector<long double> densities(const OraclePath& path);
/// Weight of each strategy: density^exponent over the sum of all (Veach 1997, section 9.2).
std::vector<long double> weights(const OraclePath& path, int exponent);

}  // namespace ajar::kit
