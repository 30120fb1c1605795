#include "kit/oracle.h"

#include <cmath>
#include <cstddef>

namespace ajar::kit {

namespace {

// Whether the lens sees vertex x_s, itself or by way of deltas.
bool is_seen(const OraclePath& path, size_t s) {
  bool seen = true;
  for (size_t i = s + 1; i + 1 < path.vertices.size(); ++i) seen = seen && path.vertices[i].delta;
  return seen;
}

}  // namespace

std::vector<long double> densities(const OraclePath& path) {
  const auto& x = path.vertices;
  const size_t n = x.size();
  std::vector<long double> out(2 * n, 0);
  for (size_t s = 0; s < n; ++s) {
    const size_t t = n - s;
    const bool joined_at_delta = s > 0 && (x[s - 1].delta || x[s].delta);
    if (joined_at_delta || (s == 0 && !path.hittable) || (s == 1 && t == 1)) continue;
    const bool seen = is_seen(path, s);
    long double product = t == 1   ? path.light_paths
                          : s >= 2 ? (seen ? path.seen : path.inner)
                          : s == 1 ? (seen ? path.first_seen : 1)
                                   : 1;
    for (size_t i = 0; i < s; ++i) product *= i == 0 && s == 1 ? path.nee : x[i].light;
    for (size_t i = s; i < n; ++i) product *= i == n - 1 ? 1 : x[i].camera;
    out[s] = product;
  }
  for (size_t j = 1; j + 1 < n; ++j) {
    if (x[j].delta) continue;
    long double product = x[j].merge * (is_seen(path, j) ? 1 : path.merge_inner);
    for (size_t i = 0; i <= j; ++i) product *= x[i].light;
    for (size_t i = j; i + 1 < n; ++i) product *= x[i].camera;
    out[n + j] = product;
  }
  return out;
}

std::vector<long double> weights(const OraclePath& path, int exponent) {
  std::vector<long double> out = densities(path);
  long double largest = 0, sum = 0;
  for (const long double p : out) largest = std::fmax(largest, p);
  if (!(largest > 0)) return out;
  for (long double& p : out) sum += p = std::pow(p / largest, static_cast<long double>(exponent));
  for (long double& p : out) p /= sum;
  // s = 0 and s = 1 share by the number of rays what they have.
  const long double counted = is_seen(path, 1) ? path.first_seen : 1;
  const long double rays = std::pow(path.next_events / counted, static_cast<long double>(exponent));
  const long double pair = out[0] + out[1], split = out[0] + rays * out[1];
  if (split > 0) out[0] *= pair / split, out[1] *= rays * pair / split;
  return out;
}

}  // namespace ajar::kit
