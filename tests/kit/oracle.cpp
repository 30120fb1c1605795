#include "kit/oracle.h"

#include <cmath>
#include <cstddef>

namespace ajar::kit {

std::vector<long double> densities(const OraclePath& path) {
  const auto& x = path.vertices;
  const size_t n = x.size();
  std::vector<long double> out(2 * n, 0);
  for (size_t s = 0; s < n; ++s) {
    const size_t t = n - s;
    const bool joined_at_delta = s > 0 && (x[s - 1].delta || x[s].delta);
    if (joined_at_delta || (s == 0 && !path.hittable) || (s == 1 && t == 1)) continue;
    bool seen = true;
    for (size_t i = s + 1; i + 1 < n; ++i) seen = seen && x[i].delta;
    long double product = t == 1 ? path.light_paths : s >= 2 ? (seen ? path.seen : path.inner) : 1;
    for (size_t i = 0; i < s; ++i) product *= i == 0 && s == 1 ? path.nee : x[i].light;
    for (size_t i = s; i < n; ++i) product *= i == n - 1 ? 1 : x[i].camera;
    out[s] = product;
  }
  for (size_t j = 1; j + 1 < n; ++j) {
    if (x[j].delta) continue;
    bool straight = true;
    for (size_t i = j + 1; i + 1 < n; ++i) straight = straight && x[i].delta;
    long double product = x[j].merge * (straight ? 1 : path.merge_inner);
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
  return out;
}

}  // namespace ajar::kit
