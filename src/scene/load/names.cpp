#include <fmt/format.h>

#include <algorithm>

#include "loader.h"

namespace ajar {
namespace {

// Complex indices of refraction as linear RGB: measured spectra under the CIE 1931 functions and the sRGB matrix,
// equal-energy weights. Measurements: Palik, Handbook of Optical Constants of Solids (1985, 1991); Johnson and
// Christy 1972 (Ag, Au, Cu); Zollner, Lin, Schönherr, Böhringer and Cardona 1989 (AlSb). Where a product of the matrix
// was below 0 it stands as 0.
constexpr Metal metals[] = {
    {"none", Rgb(0), Rgb(1)},  // mirrors everything
    {"a-C", {2.9441f, 2.2272f, 1.9682f}, {0.8874f, 0.7993f, 0.8153f}},
    {"Ag", {0.1553f, 0.1167f, 0.1384f}, {4.8283f, 3.1222f, 2.1470f}},
    {"Al", {1.6575f, 0.8804f, 0.5212f}, {9.2239f, 6.2695f, 4.8370f}},
    {"AlAs", {3.6051f, 3.2329f, 2.2176f}, {0.0007f, 0.0f, 0.0074f}},
    {"AlSb", {4.5949f, 4.0692f, 4.5801f}, {0.0f, 0.0941f, 1.2997f}},
    {"Au", {0.1431f, 0.3750f, 1.4425f}, {3.9832f, 2.3857f, 1.6032f}},
    {"Be", {4.1851f, 3.1851f, 2.7841f}, {3.8354f, 3.0101f, 2.8690f}},
    {"Cr", {4.3697f, 2.9167f, 1.6547f}, {5.2064f, 4.2314f, 3.7549f}},
    {"CsI", {2.1449f, 1.7023f, 1.6624f}, {0.0f, 0.0f, 0.0f}},
    {"Cu", {0.2004f, 0.9240f, 1.1022f}, {3.9129f, 2.4528f, 2.1422f}},
    {"Cu2O", {3.5493f, 2.9521f, 2.7369f}, {0.1132f, 0.1947f, 0.6002f}},
    {"CuO", {3.2454f, 2.4496f, 2.1974f}, {0.5203f, 0.5707f, 0.7172f}},
    {"d-C", {2.7113f, 2.3186f, 2.2289f}, {0.0f, 0.0f, 0.0f}},
    {"Hg", {2.3989f, 1.4400f, 0.9096f}, {6.3276f, 4.3719f, 3.4218f}},
    {"HgTe", {4.7795f, 3.2310f, 2.6600f}, {1.6320f, 1.5808f, 1.7296f}},
    {"Ir", {3.0864f, 2.0822f, 1.6179f}, {5.5922f, 4.0672f, 3.2673f}},
    {"K", {0.0640f, 0.0464f, 0.0382f}, {2.1042f, 1.3489f, 0.9132f}},
    {"Li", {0.2658f, 0.1956f, 0.2209f}, {3.5402f, 2.3111f, 1.6686f}},
    {"MgO", {2.0896f, 1.6507f, 1.5949f}, {0.0f, 0.0f, 0.0f}},
    {"Mo", {4.4837f, 3.5255f, 2.7761f}, {4.1111f, 3.4209f, 3.1506f}},
    {"Na", {0.0603f, 0.0561f, 0.0620f}, {3.1793f, 2.1125f, 1.5791f}},
    {"Nb", {3.4201f, 2.7902f, 2.3956f}, {3.4414f, 2.7376f, 2.5799f}},
    {"Ni", {2.3673f, 1.6633f, 1.4671f}, {4.4988f, 3.0502f, 2.3454f}},
    {"Rh", {2.5858f, 1.8602f, 1.5544f}, {6.7823f, 4.7030f, 3.9761f}},
    {"Se", {4.0593f, 2.8427f, 2.8208f}, {0.7544f, 0.6385f, 0.5216f}},
    {"SiC", {3.1723f, 2.5260f, 2.4794f}, {0.0f, 0.0f, 0.0f}},
    {"SnTe", {4.5252f, 1.9812f, 1.2817f}, {0.0f, 0.0f, 0.0f}},
    {"Ta", {2.0626f, 2.3931f, 2.6281f}, {2.4080f, 1.7414f, 1.9470f}},
    {"Te", {7.3908f, 4.4821f, 2.6371f}, {3.2561f, 3.5274f, 3.2922f}},
    {"ThF4", {1.8307f, 1.4422f, 1.3876f}, {0.0f, 0.0f, 0.0f}},
    {"TiC", {3.7005f, 2.8374f, 2.5823f}, {3.2657f, 2.3516f, 2.1728f}},
    {"TiN", {1.6485f, 1.1504f, 1.3798f}, {3.3685f, 1.9435f, 1.1020f}},
    {"TiO2", {3.4566f, 2.8017f, 2.9051f}, {0.0001f, 0.0f, 0.0006f}},
    {"V", {4.2775f, 3.5132f, 2.7611f}, {3.4912f, 2.8894f, 3.1117f}},
    {"VC", {3.6576f, 2.7527f, 2.5327f}, {3.0684f, 2.1987f, 1.9632f}},
    {"VN", {2.8656f, 2.1192f, 1.9401f}, {3.0323f, 2.0561f, 1.6163f}},
    {"W", {4.3707f, 3.3003f, 2.9983f}, {3.5007f, 2.6049f, 2.2732f}},
};

struct NamedIor {
  const char* name;
  double ior;
};
// Sodium D line (589 nm); the names and values that Mitsuba's documentation lists.
constexpr NamedIor dielectrics[] = {
    {"vacuum", 1},        {"helium", 1.000036},        {"hydrogen", 1.000132},
    {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.333},
    {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
    {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
    {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
    {"pyrex", 1.47},      {"acrylic glass", 1.49},     {"polypropylene", 1.49},
    {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
    {"pet", 1.575},       {"diamond", 2.419}};

std::string key(std::string name) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    if (c == '_') c = ' ';
  }
  return name;
}

template <class Table>
std::string list(const Table& table) {
  std::string names;
  for (const auto& entry : table) names += (names.empty() ? "" : ", ") + std::string(entry.name);
  return names;
}

}  // namespace

const Metal* find_metal(const std::string& name) {
  std::string wanted = key(name);
  if (wanted.ends_with(" palik")) wanted.resize(wanted.size() - 6);
  const auto same = [&](const Metal& m) { return key(m.name) == wanted; };
  const auto found = std::find_if(std::begin(metals), std::end(metals), same);
  return found == std::end(metals) ? nullptr : found;
}

std::string metal_names() { return list(metals); }

std::optional<double> find_dielectric(const std::string& name) {
  for (const NamedIor& d : dielectrics)
    if (key(d.name) == key(name)) return d.ior;
  return {};
}

std::string dielectric_names() { return list(dielectrics); }

}  // namespace ajar
