// Daylight: sky and sun after Preetham, Shirley and Smits 1999, "A Practical Analytic Model for Daylight".

#include <fmt/format.h>

#include <cmath>

#include "ajar/core/parallel.h"
#include "loader.h"

namespace ajar {
namespace {

struct Daylight {
  double turbidity = 3, zenith = 0;  // of the sun, from +y [rad]
  DVec3 sun{0, 1, 0};                // towards it, in the sky's space: +y is up, -z north
  Mat4 to_world{1};                  // of the sky's space
  double stretch = 1;                // the sky's zenith distances, and the sun's, are so many times those of the model
  bool extend = false;               // below the horizon it goes on as it is there
};

constexpr double sun_diameter = 0.5358;  // degrees

DVec3 direction_of(double zenith, double azimuth) {
  return {std::sin(azimuth) * std::sin(zenith), std::cos(zenith), -std::cos(azimuth) * std::sin(zenith)};
}

// Where the sun stands (Blanco-Muriel et al. 2001, "Computing the solar vector").
void place_sun(Params& p, Daylight& day) {
  const int year = integer(p, "year", 2010, 1900, 2200), month = integer(p, "month", 7, 1, 12),
            date = integer(p, "day", 10, 1, 31);
  const double hours =
      number(p, "hour", 15) + number(p, "minute", 0) / 60 + number(p, "second", 0) / 3600 - number(p, "timezone", 9);
  const double latitude = glm::radians(number(p, "latitude", 35.6894)), longitude = number(p, "longitude", 139.6917);
  const int late = (month - 14) / 12;
  const int julian = (1461 * (year + 4800 + late)) / 4 + (367 * (month - 2 - 12 * late)) / 12 -
                     (3 * ((year + 4900 + late) / 100)) / 4 + date - 32075;
  const double n = julian - 0.5 + hours / 24 - 2451545.0;
  const double omega = 2.1429 - 0.0010394594 * n, mean = 4.8950630 + 0.017202791698 * n,
               anomaly = 6.2400600 + 0.0172019699 * n;
  const double ecliptic = mean + 0.03341607 * std::sin(anomaly) + 0.00034894 * std::sin(2 * anomaly) - 0.0001134 -
                          0.0000203 * std::sin(omega);
  const double obliquity = 0.4090928 - 6.2140e-9 * n + 0.0000396 * std::cos(omega);
  const double ascension = std::atan2(std::cos(obliquity) * std::sin(ecliptic), std::cos(ecliptic));
  const double declination = std::asin(std::sin(obliquity) * std::sin(ecliptic));
  const double sidereal = glm::radians((6.6974243242 + 0.0657098283 * n + hours) * 15 + longitude);
  const double angle = sidereal - ascension;
  const double zenith = std::acos(std::cos(latitude) * std::cos(angle) * std::cos(declination) +
                                  std::sin(declination) * std::sin(latitude));
  const double azimuth =
      std::atan2(-std::sin(angle), std::tan(declination) * std::cos(latitude) - std::sin(latitude) * std::cos(angle));
  day.zenith = zenith + 6371.01 / 149597890 * std::sin(zenith);  // parallax
  // counted from -z over +x; in Mitsuba 3 from +x over +y
  day.sun = direction_of(day.zenith, p.loader.document.old ? azimuth : std::numbers::pi / 2 - azimuth);
}

// +y of the sky's space is +z of the light's own since Mitsuba 3.
Mat4 sky_to_world(Params& p) {
  const DMat4 m = regular_to_world(p), rise({1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, 0, 1});
  return orientation(p.loader.document.old ? m : m * rise);
}

// Parameters that sky, sun and sunsky share; Mitsuba's names.
Daylight daylight(Params& p) {
  Daylight day;
  day.turbidity = number(p, "turbidity", 3);
  if (!(day.turbidity >= 1 && day.turbidity <= 10)) fail(p.loader, p.node, "turbidity should be from 1 to 10");
  day.to_world = sky_to_world(p);
  place_sun(p, day);
  if (const Node* d = find(p, {"sun_direction"})) {
    const DVec3 towards = vector_of(p.loader, *d, 0);
    if (!(glm::length(towards) > 1e-30)) fail(p.loader, *d, "its direction is the zero vector");
    day.sun = glm::normalize(glm::inverse(glm::dmat3(glm::dmat4(day.to_world))) * glm::normalize(towards));
    day.zenith = std::acos(std::clamp(day.sun.y, -1.0, 1.0));
  }
  if (!p.loader.document.old) return day;
  day.stretch = number(p, "stretch", 1);
  if (!(day.stretch >= 1 && day.stretch <= 2)) fail(p.loader, p.node, "stretch should be from 1 to 2");
  day.extend = boolean(p, "extend", false);
  return day;
}

// A direction at another distance from the zenith.
DVec3 at_zenith_distance(const DVec3& w, double angle) {
  const double across = std::hypot(w.x, w.z), scale = across > 0 ? std::sin(angle) / across : 0;
  return {w.x * scale, std::cos(angle), w.z * scale};
}

struct Perez {
  double a, b, c, d, e;
};
double perez(const Perez& k, double cos_zenith, double gamma) {
  return (1 + k.a * std::exp(k.b / cos_zenith)) *
         (1 + k.c * std::exp(k.d * gamma) + k.e * std::cos(gamma) * std::cos(gamma));
}

// Luminance and chromaticity over the sky: zenith values and distributions, appendix A.2 of the paper.
struct Sky {
  Daylight day;
  Perez of[3];      // Y, x, y
  double scale[3];  // zenith value over the distribution there
};

// The paper's fits begin at turbidity 2: below, the distribution passes through zero, and grows without bounds.
constexpr double clearest = 2;

Sky make_sky(const Daylight& day) {
  const double t = std::max(day.turbidity, clearest), s = day.zenith;
  Sky sky{
      day,
      {{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771, -0.0670 * t + 0.3703},
       {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989, -0.0033 * t + 0.0452},
       {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537, -0.0109 * t + 0.0529}},
      {}};
  const double chi = (4.0 / 9 - t / 120) * (std::numbers::pi - 2 * s);
  const double luminance = std::max((4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192, 0.0);  // kcd/m^2
  const auto chromaticity = [&](const double(&m)[3][4]) {
    const auto row = [&](int i) { return ((m[i][0] * s + m[i][1]) * s + m[i][2]) * s + m[i][3]; };
    return (row(0) * t + row(1)) * t + row(2);
  };
  const double x = chromaticity(
      {{0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}});
  const double y = chromaticity(
      {{0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}});
  const double zenith[] = {luminance, x, y};
  for (int i = 0; i < 3; ++i) sky.scale[i] = zenith[i] / perez(sky.of[i], 1, s);
  return sky;
}

// kcd/m^2 to radiance per nanometre as the eye weighs it, the unit of spectra here: 683 lm/W, and the integral of the
// luminosity function, 106.857 nm.
constexpr double per_kilocandela = 1000 / (683 * 106.857);

// Of what is seen at the horizon, so much is left where an extended sky goes on below it, as Mitsuba 0.6 has it.
double below_horizon(const DVec3& w) {
  const double t = std::clamp(2 - 2 * std::acos(std::clamp(w.y, -1.0, 1.0)) / std::numbers::pi, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Rgb radiance(const Sky& sky, DVec3 w) {
  const double fades = sky.day.extend ? below_horizon(w) : 1;
  if (sky.day.stretch != 1) w = at_zenith_distance(w, std::acos(std::clamp(w.y, -1.0, 1.0)) / sky.day.stretch);
  if (!(w.y > 0) && sky.day.extend) w = at_zenith_distance(w, std::acos(1e-4));
  if (!(w.y > 0)) return Rgb(0);
  const double cos_zenith = std::max(w.y, 1e-3), gamma = std::acos(std::clamp(glm::dot(w, sky.day.sun), -1.0, 1.0));
  double v[3];
  for (int i = 0; i < 3; ++i) v[i] = sky.scale[i] * perez(sky.of[i], cos_zenith, gamma);
  const double Y = std::max(v[0], 0.0) * per_kilocandela, y = std::max(v[2], 1e-3);
  const DVec3 xyz(v[1] / y * Y, Y, (1 - v[1] - v[2]) / y * Y);
  return float(fades) * Rgb(glm::max(DVec3(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                                           -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                                           0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z),
                                     DVec3(0)));
}

// Absorption of ozone [1/cm], every 10 nm from 450 (Iqbal 1983, as in appendix A.1).
constexpr double ozone[] = {3,   6,   9,   14,  21,  30, 40, 48, 63, 75, 85, 103, 120,
                            120, 115, 125, 120, 105, 90, 79, 67, 57, 48, 36, 28,  23};

// Radiance of the sun's disc behind the air: Planck's law at 5778 K, thinned as in appendix A.1 by Rayleigh scattering,
// aerosols and ozone. Bands of other gases and of water lie at the edge of the visible, and are left out.
Rgb sun_radiance(const Daylight& day) {
  const double degrees = glm::degrees(day.zenith);
  const double mass = 1 / (std::cos(day.zenith) + 0.15 * std::pow(93.885 - degrees, -1.253));
  const double beta = 0.04608365822050 * day.turbidity - 0.04586025928522;
  std::vector<std::pair<double, double>> list;
  for (int nm = 380; nm <= 780; nm += 10) {
    const double micro = nm * 1e-3, metre = nm * 1e-9;
    const double planck = 2 * 6.62607015e-34 * 2.99792458e8 * 2.99792458e8 / std::pow(metre, 5) /
                          (std::exp(6.62607015e-34 * 2.99792458e8 / (metre * 1.380649e-23 * 5778)) - 1) *
                          1e-9;  // per nm
    const int k = (nm - 450) / 10;
    const double absorbed = nm >= 450 && k < int(std::size(ozone)) ? ozone[k] * 1e-3 : 0;
    const double depth = 0.008735 * std::pow(micro, -4.08) + beta * std::pow(micro, -1.3) + 0.35 * absorbed;
    list.push_back({nm, planck * std::exp(-depth * mass)});
  }
  return glm::max(rgb_of_list(std::move(list), Colour::emission), Rgb(0));  // a low sun is redder than sRGB can say
}

double scale_of(Params& p, const char* name, double otherwise) {
  const double scale = number(p, name, otherwise);
  if (scale < 0) fail(p.loader, p.node, fmt::format("{} should not be negative", name));
  return scale;
}

void add_sky(Params& p, const Daylight& day, double scale, float weight) {
  const int width = integer(p, "resolution", 512, 8, 8192), height = width / 2;
  if (day.turbidity < clearest)
    note(p.loader, p.node, fmt::format("the sky is that of turbidity {}: its model knows no clearer air", clearest));
  const Sky sky = make_sky(day);
  Image image;
  image.width = width, image.height = height, image.channels = 3;
  image.name = "sky";
  image.floats.resize(size_t(width) * size_t(height) * 3);
  parallel_for(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const Rgb c =
          radiance(sky, direction_of(std::numbers::pi * (y + 0.5) / height, 2 * std::numbers::pi * (x + 0.5) / width));
      for (int k = 0; k < 3; ++k) image.floats[(size_t(y) * size_t(width) + size_t(x)) * 3 + size_t(k)] = c[k];
    }
  });
  Scene& scene = p.loader.scene;
  const uint32_t id = uint32_t(scene.images.size());
  scene.images.push_back(std::move(image));
  Light light;
  light.kind = LightKind::envmap;
  light.to_world = day.to_world;
  light.sampling_weight = weight;
  light.environment = uint32_t(scene.environments.size());
  scene.environments.push_back(make_environment(scene, id, float(scale)));
  scene.lights.push_back(light);
}

// Half the angle across the sun [rad].
double sun_half(Params& p) {
  const double wide = scale_of(p, "sun_radius_scale", 1), across = scale_of(p, "sun_aperture", sun_diameter);
  const double half = has(p, "sun_aperture") ? glm::radians(across / 2) : glm::radians(sun_diameter / 2) * wide;
  if (half > glm::radians(60.0)) fail(p.loader, p.node, "the sun should be smaller than 120 degrees");
  return half;
}

// A larger disc gives as much light as the sun's own, and so does a direction alone.
void add_sun(Params& p, const Daylight& day, double scale, float weight) {
  const double half = sun_half(p), own = sqr(std::sin(glm::radians(sun_diameter / 4)));
  Light light;
  light.kind = half < 1e-6 ? LightKind::directional : LightKind::sun;
  light.sampling_weight = weight;
  const DVec3 at = day.stretch == 1 ? day.sun : at_zenith_distance(day.sun, day.zenith * day.stretch);
  light.direction = -Vec3(glm::normalize(glm::dmat3(glm::dmat4(day.to_world)) * at));
  double dimmer = 4 * std::numbers::pi * own;
  if (light.kind == LightKind::sun) {
    light.cone = float(2 * std::sin(half / 2) * std::sin(half / 2));
    dimmer = sqr(std::sin(glm::radians(sun_diameter / 4)) / std::sin(half / 2));
  }
  light.radiance = Slot(sun_radiance(day) * float(scale * dimmer));
  p.loader.scene.lights.push_back(light);
}

}  // namespace

void load_daylight(Params& p, bool with_sky, bool with_sun) {
  const Daylight day = daylight(p);
  const double weight = number(p, "sampling_weight", 1), scale = scale_of(p, "scale", 1);
  if (weight < 0) fail(p.loader, p.node, "sampling_weight should not be negative");
  const bool both = with_sky && with_sun;
  const double of_sky = both ? scale_of(p, "sky_scale", scale) : scale,
               of_sun = both ? scale_of(p, "sun_scale", scale) : scale;
  if (day.zenith > glm::radians(90.001)) {  // the horizon, turned and rounded
    const std::string night = "the sun is below the horizon";
    if (p.loader.document.old)
      fail(p.loader, p.node, night + ": take another sun_direction, or another time and place");
    for (const char* unread : {"resolution", "sun_radius_scale", "sun_aperture"}) find(p, {unread});
    return note(p.loader, p.node, night + ": neither it nor the sky shines");
  }
  if (with_sky) add_sky(p, day, of_sky, float(weight));
  if (with_sun) add_sun(p, day, of_sun, float(weight));
}

}  // namespace ajar
