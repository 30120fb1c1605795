// Enters: a material's parameters at one point, textures evaluated.
// Leaves: Lobe, one elementary scattering function as a small tagged value without pointers to follow (one exception,
// said there).
#pragma once

#include <algorithm>

#include "ajar/scene/material.h"

namespace ajar {

/// Statistics of a microfacet surface: widths of the slope distribution along s and t.
struct Facets {
  float alpha_u, alpha_v;  ///< from min_alpha to max_alpha
  Microfacet kind;
};
inline float narrower(const Facets& f) { return std::min(f.alpha_u, f.alpha_v); }

/// Roughness below this is raised to it: float half vectors resolve no finer peak, and images do not show one.
inline constexpr float min_alpha = 1e-4f;
/// Of a texture's roughness no more is taken; loaders refuse more of a number. Squares of it are far from what floats
/// hold.
inline constexpr float max_alpha = 100;

/// A rough boundary whose indices differ by less is taken as smooth: its half vectors would be rounding noise.
inline constexpr float min_ior_step = 1e-3f;

struct Diffuse {
  Rgb reflectance;
};

/// Oren and Nayar 1994: Lambertian facets of V-shaped grooves.
struct RoughDiffuse {
  Rgb reflectance;
  float variance;  ///< of the facets' slope angle [rad^2]
  bool simple;     ///< their qualitative model (section 4.4), without interreflection
};

/// Lambertian, to the other side alone.
struct DiffuseTransmitter {
  Rgb transmittance;
};

struct Conductor {
  Rgb specular, eta, k;
};

struct RoughConductor {
  Rgb specular, eta, k;
  Facets facets;
};

struct Dielectric {
  Rgb reflectance, transmittance;
  float ior;
};

struct RoughDielectric {
  Rgb reflectance, transmittance;
  float ior;  ///< differs from 1 by min_ior_step at least
  Facets facets;
};

/// A pane without thickness, all orders of internal reflection summed.
struct ThinDielectric {
  Rgb reflectance, transmittance;
  float ior;
};

/// Diffuse base under a smooth dielectric. base is what is left of the diffuse reflectance after all internal
/// reflections.
struct Plastic {
  Rgb base;  ///< rho / (eta^2 (1 - rho Fdr)) or rho / (eta^2 (1 - Fdr))
  Rgb specular;
  float ior;
  float share;     ///< of specular in specular + diffuse reflectance: steers the choice
  float entering;  ///< diffuse transmittance from outside, 1 - Fdr(outside): albedo only
};

/// Diffuse base under a rough dielectric.
struct RoughPlastic {
  const float*
      table;      ///< transmittance over cosine, a row of Material::entering_table of the scene it was resolved from
  float between;  ///< position between that row and the next, in [0, 1)
  Rgb base, specular;
  float ior, share;
  Facets facets;
};

/// Modified Phong (Lafortune and Willems 1994), normalised.
struct Phong {
  Rgb diffuse, specular;
  float exponent;
  float share;
};

/// Elliptic Gaussian lobe of Ward 1992 over a diffuse base.
struct Ward {
  Rgb diffuse, specular;
  Facets facets;
  float share;
  WardKind kind;
};

/// Burley 2012 and 2015; Material says what each number means.
struct Principled {
  Rgb base;
  float roughness, aspect;
  float metallic, spec_trans, eta, spec_tint, sheen, sheen_tint, flatness;
  float clearcoat, clearcoat_alpha;
};

enum class LobeKind : uint8_t {
  diffuse,
  conductor,
  roughconductor,
  dielectric,
  roughdielectric,
  thindielectric,
  plastic,
  roughplastic,
  phong,
  principled,
  roughdiffuse,
  difftrans,
  ward,
};

/// One cache line long. Left uninitialised until a kind is assigned, so that a diffuse vertex writes 16 bytes, not 64.
struct Lobe {
  union {
    Diffuse diffuse;
    Conductor conductor;
    RoughConductor roughconductor;
    Dielectric dielectric;
    RoughDielectric roughdielectric;
    ThinDielectric thindielectric;
    Plastic plastic;
    RoughPlastic roughplastic;
    Phong phong;
    Principled principled;
    RoughDiffuse roughdiffuse;
    DiffuseTransmitter difftrans;
    Ward ward;
  };
  LobeKind kind;

  Lobe() {}  // NOLINT: deliberately leaves the value open
};
static_assert(sizeof(Lobe) == 64);

}  // namespace ajar
