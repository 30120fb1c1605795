// FLIP: A Difference Evaluator for Alternating Images (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom,
// Fairchild; High Performance Graphics 2020): the colour pipeline of its section 4.1, the feature pipeline of 4.2,
// joined as in 4.3.
#include <fmt/format.h>

#include "ajar/core/error.h"
#include "ajar/report/metrics.h"
#include "planes.h"

namespace ajar {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr double pi_d = std::numbers::pi;
constexpr double qc = 0.7, pc = 0.4, pt = 0.95;  // exponent of the colour difference, knee of its map to [0,1]
constexpr double qf = 0.5,
                 feature_width = 0.082;  // exponent of the feature difference, width of the detectors in degrees

/// One Gaussian of a contrast sensitivity filter, a sqrt(pi / b) exp(-pi^2 x^2 / b) with x in degrees.
struct Lobe {
  double a, b;
};
constexpr Lobe achromatic{1, 0.0047}, red_green{1, 0.0053}, blue_yellow[2] = {{34.1, 0.04}, {13.5, 0.025}};

/// Linear sRGB to XYZ divided by that of its white, D65, and back. Both pipelines need XYZ in these units only.
struct ColourSpace {
  dmat3 to_xyz, to_rgb;
};

ColourSpace colour_space() {
  // Rows X, Y, Z of the primaries of IEC 61966-2-1 as exact fractions, as the authors' evaluations have them.
  dmat3 rows(dvec3(10135552, 8788810, 4435075) / 24577794.0, dvec3(2613072, 8788810, 887015) / 12288897.0,
             dvec3(1425312, 8788810, 70074185) / 73733382.0);
  for (int i = 0; i < 3; ++i) rows[i] /= rows[i].x + rows[i].y + rows[i].z;
  const dmat3 to_xyz = glm::transpose(rows);
  return {to_xyz, glm::inverse(to_xyz)};
}

/// CIELab with a and b scaled by L / 100, after Hunt: chromatic differences are seen less in the dark.
dvec3 hunt_lab(const ColourSpace& space, const dvec3& rgb) {
  constexpr double delta = 6.0 / 29;
  const auto f = [](double t) { return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29; };
  const dvec3 xyz = space.to_xyz * rgb;
  const double fx = f(xyz.x), fy = f(xyz.y), fz = f(xyz.z), lightness = 116 * fy - 16;
  return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
}

/// HyAB distance: city block between lightness and chroma, Euclidean within chroma.
double hyab(const dvec3& p, const dvec3& q) { return std::abs(p.x - q.x) + std::hypot(p.y - q.y, p.z - q.z); }

/// XYZ over white, of the picture clipped to [0,1]. FLIP's opponent space Y Cx Cz is linear in it.
std::array<Plane, 3> xyz_planes(const ColourSpace& space, const Picture& picture) {
  std::array<Plane, 3> planes = rgb_planes(picture);
  for (size_t i = 0; i < planes[0].size(); ++i) {
    const dvec3 rgb = glm::clamp(dvec3(planes[0][i], planes[1][i], planes[2][i]), 0.0, 1.0);
    const dvec3 xyz = space.to_xyz * rgb;
    for (int c = 0; c < 3; ++c) planes[size_t(c)][i] = xyz[c];
  }
  return planes;
}

double deviation(const Lobe& lobe, double pixels_per_degree) {
  return std::sqrt(lobe.b / (2 * pi_d * pi_d)) * pixels_per_degree;
}

Plane filter_lobe(const Plane& plane, const Lobe& lobe, int radius, double pixels_per_degree) {
  const std::vector<double> kernel = gaussian_kernel(deviation(lobe, pixels_per_degree), radius);
  return filter_separable(plane, kernel, kernel);
}

/// A filter of two lobes is not separable, but each lobe is: their results, weighted by each lobe's sum over the
/// kernel.
Plane filter_blue_yellow(const Plane& plane, int radius, double pixels_per_degree) {
  Plane out = make_plane(plane.width, plane.height);
  double weights[2], total = 0;
  for (int l = 0; l < 2; ++l) {
    const double s = deviation(blue_yellow[l], pixels_per_degree);
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) sum += std::exp(-i * i / (2 * s * s));
    weights[l] = blue_yellow[l].a * std::sqrt(pi_d / blue_yellow[l].b) * sum * sum;
    total += weights[l];
  }
  for (int l = 0; l < 2; ++l) {
    const Plane part = filter_lobe(plane, blue_yellow[l], radius, pixels_per_degree);
    for (size_t i = 0; i < out.size(); ++i) out[i] += weights[l] / total * part[i];
  }
  return out;
}

/// What the eye sees of the picture: per pixel the Hunt-adjusted Lab after the contrast sensitivity filters.
std::vector<dvec3> seen_colours(const ColourSpace& space, const std::array<Plane, 3>& xyz, double pixels_per_degree) {
  const int radius = int(std::ceil(3 * deviation(blue_yellow[0], pixels_per_degree)));  // the widest lobe's
  Plane cx = xyz[0], cz = xyz[1];                                                       // up to factors 500 and 200
  for (size_t i = 0; i < cx.size(); ++i) {
    cx[i] -= xyz[1][i];
    cz[i] -= xyz[2][i];
  }
  const Plane y = filter_lobe(xyz[1], achromatic, radius, pixels_per_degree);
  cx = filter_lobe(cx, red_green, radius, pixels_per_degree);
  cz = filter_blue_yellow(cz, radius, pixels_per_degree);
  std::vector<dvec3> seen(y.size());
  for (size_t i = 0; i < seen.size(); ++i) {
    const dvec3 rgb = space.to_rgb * dvec3(y[i] + cx[i], y[i], y[i] - cz[i]);
    seen[i] = hunt_lab(space, glm::clamp(rgb, 0.0, 1.0));
  }
  return seen;
}

struct Kernels {
  std::vector<double> smooth, edge, point;  ///< a Gaussian, its first and its second derivative
};

/// Positive and negative weights of the derivatives are normalised to sums of 1 and -1.
Kernels feature_kernels(double pixels_per_degree) {
  const double s = 0.5 * feature_width * pixels_per_degree;
  const int radius = int(std::ceil(3 * s));
  Kernels kernels{gaussian_kernel(s, radius), {}, {}};
  for (int i = -radius; i <= radius; ++i) {
    const double g = kernels.smooth[size_t(i + radius)];
    kernels.edge.push_back(-i * g);
    kernels.point.push_back((i * i / (s * s) - 1) * g);
  }
  for (std::vector<double>* kernel : {&kernels.edge, &kernels.point}) {
    double positive = 0, negative = 0;
    for (const double w : *kernel) (w > 0 ? positive : negative) += w;
    for (double& w : *kernel) w /= w > 0 ? positive : -negative;
  }
  return kernels;
}

/// Magnitude of the response to a detector in x and in y.
Plane detect(const Plane& luminance, std::span<const double> detector, std::span<const double> smooth) {
  Plane out = filter_separable(luminance, detector, smooth);
  const Plane along_y = filter_separable(luminance, smooth, detector);
  for (size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(out[i], along_y[i]);
  return out;
}

/// The colour difference in [0,1]: most of the range for the differences below pc of the largest one, green to blue.
double map_colour(double distance, double largest) {
  const double power = std::pow(distance, qc), knee = pc * largest;
  return power < knee ? pt / knee * power : pt + (power - knee) / (largest - knee) * (1 - pt);
}

}  // namespace

Picture flip(const Picture& image, const Picture& reference, double pixels_per_degree) {
  require_same_size(image, reference);
  if (!(pixels_per_degree > 0 && pixels_per_degree < 1e6))
    throw Error(fmt::format("flip: {} pixels per degree are none; give more than 0, below 1000000", pixels_per_degree));
  const ColourSpace space = colour_space();
  const std::array<Plane, 3> xyz[2] = {xyz_planes(space, image), xyz_planes(space, reference)};
  const std::vector<dvec3> seen[2] = {seen_colours(space, xyz[0], pixels_per_degree),
                                      seen_colours(space, xyz[1], pixels_per_degree)};
  const Kernels kernels = feature_kernels(pixels_per_degree);
  const Plane edges[2] = {detect(xyz[0][1], kernels.edge, kernels.smooth),
                          detect(xyz[1][1], kernels.edge, kernels.smooth)};
  const Plane points[2] = {detect(xyz[0][1], kernels.point, kernels.smooth),
                           detect(xyz[1][1], kernels.point, kernels.smooth)};
  const double largest = std::pow(hyab(hunt_lab(space, {0, 1, 0}), hunt_lab(space, {0, 0, 1})), qc);

  Picture out{image.width, image.height, {"Flip"}, std::vector<float>(seen[0].size())};
  for (size_t i = 0; i < out.pixels.size(); ++i) {
    const double colour = map_colour(hyab(seen[0][i], seen[1][i]), largest);
    const double feature = std::max(std::abs(edges[0][i] - edges[1][i]), std::abs(points[0][i] - points[1][i]));
    const double feature_difference = std::min(std::pow(feature / std::numbers::sqrt2, qf), 1.0);
    out.pixels[i] = float(std::clamp(std::pow(colour, 1 - feature_difference), 0.0, 1.0));
  }
  return out;
}

}  // namespace ajar
