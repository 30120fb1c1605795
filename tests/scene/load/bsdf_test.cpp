// Every bsdf: parameters in both spellings, defaults, what is refused.
#include <fmt/format.h>

#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

// The last material read: nested ones come before what holds them.
Material last(const std::string& text, const LoadOptions& options = {}, const std::string& version = "3.0.0") {
  return load_inside(text, options, version).materials.back();
}
std::string bsdf(const std::string& type, const std::string& inside = "") {
  return fmt::format("<bsdf type='{}'>{}</bsdf>", type, inside);
}
std::string number(const std::string& name, double value) {
  return fmt::format("<float name='{}' value='{}'/>", name, value);
}
std::string word(const std::string& name, const std::string& value) {
  return fmt::format("<string name='{}' value='{}'/>", name, value);
}
const std::string checker = "<texture type='checkerboard'/>";
std::string texture(const std::string& name) { return fmt::format("<texture name='{}' type='checkerboard'/>", name); }

TEST(Bsdf, Diffuse) {
  Material m = last(bsdf("diffuse"));
  EXPECT_EQ(m.kind, MaterialKind::diffuse);
  EXPECT_RGB(m.reflectance.value, 0.5, 0.5, 0.5, 0);
  EXPECT_NE(last(bsdf("diffuse", texture("reflectance"))).reflectance.texture, none);
  EXPECT_NE(last(bsdf("diffuse", texture("diffuseReflectance"))).reflectance.texture, none);
  EXPECT_NE(last(bsdf("diffuse", checker)).reflectance.texture, none);
}

// Numbers of lobes would leave their range.
TEST(Bsdf, WidthsHaveALimit) {
  for (const char* type : {"roughconductor", "roughdielectric", "roughplastic", "roughdiffuse", "ward"}) {
    EXPECT_SAYS(error_of(bsdf(type, number("alpha", 1e30))), "alpha should be at most 100") << type;
    EXPECT_EQ(error_of(bsdf(type, number("alpha", 100))), "") << type;
  }
  EXPECT_SAYS(error_of(bsdf("roughconductor", number("alphaV", 101))), "alpha_v should be at most 100");
}

TEST(Bsdf, Conductor) {
  Material m = last(bsdf("conductor", word("material", "Au")));
  EXPECT_EQ(m.kind, MaterialKind::conductor);
  EXPECT_RGB(m.eta, 0.143, 0.375, 1.4425, 1e-3);
  EXPECT_RGB(m.k, 3.983, 2.386, 1.603, 1e-3);
  m = last(bsdf("conductor"));  // 2.x, 3.x: a perfect mirror
  EXPECT_RGB(m.eta, 0, 0, 0, 0);
  EXPECT_RGB(m.k, 1, 1, 1, 0);
  m = last(bsdf("conductor"), {}, "0.6.0");  // 0.x: copper
  EXPECT_RGB(m.eta, 0.2004, 0.9240, 1.1022, 1e-3);
  m = last(bsdf("conductor", number("eta", 1.5) + word("extEta", "vacuum")), {}, "0.6.0");  // of copper but for this
  EXPECT_RGB(m.eta, 1.5, 1.5, 1.5, 1e-6);
  EXPECT_RGB(m.k, 3.9129, 2.4528, 2.1422, 1e-3);
  EXPECT_RGB(last(bsdf("conductor", number("eta", 1.5))).k, 1, 1, 1, 0);
  m = last(bsdf("conductor", "<rgb name='eta' value='1 2 3'/><rgb name='k' value='4 5 6'/>" + number("extEta", 2)));
  EXPECT_RGB(m.eta, 0.5, 1, 1.5, 1e-6);
  EXPECT_RGB(m.k, 2, 2.5, 3, 1e-6);
  m = last(bsdf("conductor", number("eta", 1.5) + number("k", 3) + word("extEta", "water")));
  EXPECT_RGB(m.eta, 1.5 / 1.333, 1.5 / 1.333, 1.5 / 1.333, 1e-5);
  m = last(
      bsdf("conductor", "<spectrum name='eta' value='300:1.5, 900:1.5'/><spectrum name='k' value='300:7, 900:7'/>"));
  EXPECT_RGB(m.eta, 1.5, 1.5, 1.5, 1e-5);
  EXPECT_RGB(m.k, 7, 7, 7, 1e-5);
  EXPECT_RGB(last(bsdf("conductor", word("material", "Au_palik"))).k, 3.983, 2.386, 1.603, 1e-3);
  EXPECT_SAYS(error_of(bsdf("conductor", word("material", "Xx"))), "unknown material \"Xx\"; known are none, a-C, Ag");
  EXPECT_TRUE(says(load_inside(bsdf("conductor", word("material", "Xx")), lenient()).notes, "none in its place"));
  EXPECT_SAYS(error_of(bsdf("conductor", texture("eta"))),
              "has to be one colour here, not a texture; write <rgb name=\"eta\" value=\"...\"/>; with --lenient");
  m = last(bsdf("roughconductor", texture("eta") + texture("k")), lenient());
  EXPECT_RGB(m.eta, 0.3, 0.3, 0.3, 1e-6);
  EXPECT_RGB(m.k, 0.3, 0.3, 0.3, 1e-6);
}

TEST(Bsdf, MicrofacetParameters) {
  Material m = last(bsdf("roughconductor"));
  EXPECT_EQ(m.kind, MaterialKind::roughconductor);
  EXPECT_EQ(m.distribution, Microfacet::beckmann);
  EXPECT_FLOAT_EQ(m.alpha_u.value.x, 0.1f);
  m = last(bsdf("roughconductor", word("distribution", "GGX") + number("alphaU", 0.2) + number("alpha_v", 0.3)));
  EXPECT_EQ(m.distribution, Microfacet::ggx);
  EXPECT_FLOAT_EQ(m.alpha_u.value.x, 0.2f);
  EXPECT_FLOAT_EQ(m.alpha_v.value.x, 0.3f);
  m = last(bsdf("roughdielectric", texture("alpha")));
  EXPECT_NE(m.alpha_u.texture, none);
  EXPECT_EQ(m.alpha_v.texture, m.alpha_u.texture);
  for (const char* type : {"roughconductor", "roughdielectric", "roughplastic", "pplastic"})
    EXPECT_FLOAT_EQ(last(bsdf(type, number("alpha", 0))).alpha_u.value.x, 1e-4f) << type;
  m = last(bsdf("roughconductor", number("alpha_u", 0) + number("alpha_v", 0.2)));
  EXPECT_FLOAT_EQ(m.alpha_u.value.x, 1e-4f);
  EXPECT_FLOAT_EQ(m.alpha_v.value.x, 0.2f);
  EXPECT_SAYS(error_of(bsdf("ward", number("alpha", 0))), "<bsdf type=\"ward\">: alpha should be greater than 0");
  EXPECT_SAYS(error_of(bsdf("roughconductor", word("distribution", "cosine"))), "known are beckmann, ggx");
  const Scene s = load_inside(bsdf("roughconductor", word("distribution", "phong")));
  EXPECT_EQ(s.materials[0].distribution, Microfacet::beckmann);
  EXPECT_TRUE(says(s.notes, "phong distribution"));
}

TEST(Bsdf, Dielectrics) {
  const std::pair<const char*, MaterialKind> kinds[] = {{"dielectric", MaterialKind::dielectric},
                                                        {"roughdielectric", MaterialKind::roughdielectric},
                                                        {"thindielectric", MaterialKind::thindielectric}};
  for (const auto& [type, kind] : kinds) {
    Material m = last(bsdf(type));
    EXPECT_EQ(m.kind, kind);
    EXPECT_NEAR(m.ior, 1.5046 / 1.000277, 1e-6);
    EXPECT_RGB(m.transmittance.value, 1, 1, 1, 0);
    m = last(bsdf(type, number("intIOR", 1.33) + word("extIOR", "vacuum") +
                            "<spectrum name='specularTransmittance' value='.5'/>"
                            "<rgb name='specular_reflectance' value='.25'/>"));
    EXPECT_FLOAT_EQ(m.ior, 1.33f);
    EXPECT_FLOAT_EQ(m.transmittance.value.x, 0.5f);
    EXPECT_FLOAT_EQ(m.specular.value.x, 0.25f);
    EXPECT_NEAR(last(bsdf(type, word("int_ior", "diamond") + word("ext_ior", "1.5"))).ior, 2.419 / 1.5, 1e-6);
  }
  EXPECT_SAYS(error_of(bsdf("dielectric", word("int_ior", "kryptonite"))), "known are vacuum, helium");
  EXPECT_SAYS(error_of(bsdf("dielectric", number("int_ior", 0))), "index of refraction");
  EXPECT_SAYS(error_of(bsdf("dielectric", number("int_ior", -1.5))), "index of refraction");
}

TEST(Bsdf, Plastics) {
  Material m = last(bsdf("plastic"));
  EXPECT_EQ(m.kind, MaterialKind::plastic);
  EXPECT_NEAR(m.ior, 1.49 / 1.000277, 1e-6);
  EXPECT_EQ(m.inner, Inner::linear);
  EXPECT_RGB(m.reflectance.value, 0.5, 0.5, 0.5, 0);
  m = last(bsdf("roughplastic", "<boolean name='nonlinear' value='true'/>" + number("alpha", 0.3) +
                                    word("distribution", "ggx") + texture("diffuse_reflectance")));
  EXPECT_EQ(m.kind, MaterialKind::roughplastic);
  EXPECT_EQ(m.inner, Inner::nonlinear);
  EXPECT_FLOAT_EQ(m.alpha_u.value.x, 0.3f);
  EXPECT_EQ(m.distribution, Microfacet::ggx);
  EXPECT_NE(m.reflectance.texture, none);
  EXPECT_TRUE(m.hides);
  EXPECT_FALSE(last(bsdf("roughplastic"), {}, "0.6.0").hides);
  EXPECT_SAYS(error_of(bsdf("plastic", "<boolean name='nonlinear' value='maybe'/>")), "should be true or false");
}

TEST(Bsdf, Phong) {
  Material m = last(bsdf("phong"));
  EXPECT_FLOAT_EQ(m.exponent.value.x, 30);
  EXPECT_FLOAT_EQ(m.specular.value.x, 0.2f);
  EXPECT_FLOAT_EQ(m.reflectance.value.x, 0.5f);
  const Scene s = load_inside(bsdf("phong", number("diffuseReflectance", 0.9) + number("specularReflectance", 0.6)));
  EXPECT_NEAR(s.materials[0].reflectance.value.x, 0.6, 1e-6);
  EXPECT_NEAR(s.materials[0].specular.value.x, 0.4, 1e-6);
  EXPECT_TRUE(says(s.notes, "scaled down"));
  // Mitsuba 0.6 scales both by what they come to, and leaves a hundredth.
  const std::string bright = number("diffuseReflectance", 0.9) + number("specularReflectance", 9);
  for (const char* type : {"phong", "ward"}) {
    m = last(bsdf(type, bright), {}, "0.6.0");
    EXPECT_NEAR(m.reflectance.value.x, 0.09, 1e-6) << type;
    EXPECT_NEAR(m.specular.value.x, 0.9, 1e-6) << type;
  }
}

// By the largest sum that there may be.
TEST(Bsdf, TwoTexturedColoursAreLimited) {
  const std::string bright =
      "<texture name='diffuseReflectance' type='checkerboard'><rgb name='color0' value='0.8'/></texture>";
  for (const char* type : {"phong", "ward"}) {
    const Scene s = load_inside(bsdf(type, bright + number("specularReflectance", 0.45)));
    const Material& m = s.materials[0];
    EXPECT_RGB(maximum(s, m.reflectance), 0.64, 0.64, 0.64, 1e-6);
    EXPECT_RGB(m.specular.value, 0.36, 0.36, 0.36, 1e-6);
    EXPECT_TRUE(says(s.notes, "scaled down")) << type;
    const Scene dim = load_inside(bsdf(type, bright));
    EXPECT_RGB(maximum(dim, dim.materials[0].reflectance), 0.8, 0.8, 0.8, 1e-6);
    EXPECT_FALSE(says(dim.notes, "scaled down")) << type;
    // Without a name, and of a mesh whose colours may be anything: they count as 1 at most.
    const Scene painted =
        load_inside(bsdf(type, "<texture type='mesh_attribute'><string name='name' value='vertex_color'/></texture>"));
    EXPECT_RGB(maximum(painted, painted.materials[0].reflectance), 1 / 1.2, 1 / 1.2, 1 / 1.2, 1e-6);
  }
}

TEST(Bsdf, Principled) {
  Material m = last(bsdf("principled"));
  EXPECT_EQ(m.kind, MaterialKind::principled);
  EXPECT_FLOAT_EQ(m.ior, 1.5f);
  EXPECT_FLOAT_EQ(m.roughness.value.x, 0.5f);
  EXPECT_RGB(m.reflectance.value, 0.5, 0.5, 0.5, 0);
  m = last(bsdf("principled", "<rgb name='base_color' value='.1 .2 .3'/>" + number("roughness", 0.3) +
                                  number("spec_trans", 0.4) + number("clearcoat_gloss", 0.6) + texture("metallic") +
                                  number("specular", 0.5) + number("anisotropic", 0.7) + number("sheen", 0.8)));
  EXPECT_RGB(m.reflectance.value, 0.1, 0.2, 0.3, 1e-6);
  EXPECT_FLOAT_EQ(m.roughness.value.x, 0.3f);
  EXPECT_FLOAT_EQ(m.spec_trans.value.x, 0.4f);
  EXPECT_FLOAT_EQ(m.clearcoat_gloss.value.x, 0.6f);
  EXPECT_FLOAT_EQ(m.anisotropic.value.x, 0.7f);
  EXPECT_FLOAT_EQ(m.sheen.value.x, 0.8f);
  EXPECT_NE(m.metallic.texture, none);
  EXPECT_NEAR(m.ior, 1.5, 1e-5);  // 4 % at normal incidence
  const Scene hinted = load_inside(
      bsdf("principled", number("main_specular_sampling_rate", 2) + number("diffuse_reflectance_sampling_rate", 2)));
  EXPECT_FALSE(says(hinted.notes, "sampling_rate"));
  EXPECT_SAYS(error_of(bsdf("principled", number("specular", -1))), "specular should be");
  EXPECT_SAYS(error_of(bsdf("principled", number("specular", 12.5))), "specular should be");
  EXPECT_NEAR(last(bsdf("principled", number("specular", 2))).ior, 7.0 / 3, 1e-5);  // 16 % at normal incidence
  EXPECT_EQ(last(bsdf("principled", number("specular", 0))).ior, 1);
  EXPECT_NEAR(last(bsdf("principled", number("specular", 0) + number("spec_trans", 0.5))).ior, 1.01805,
              1e-5);  // of 0.001
  EXPECT_TRUE(
      says(load_inside(bsdf("principled", number("specular", 0.5) + number("eta", 2))).notes, "specular is used"));
  EXPECT_FLOAT_EQ(last(bsdf("principled", number("eta", 0.67))).ior, 0.67f);  // a bubble
  for (const double eta : {0.0, 1e-4, 2e3})
    EXPECT_SAYS(error_of(bsdf("principled", number("eta", eta))), "eta should be") << eta;
}

TEST(Bsdf, Twosided) {
  Scene s = load_inside(bsdf("twosided", bsdf("diffuse") + bsdf("plastic")));
  EXPECT_EQ(s.materials[2].kind, MaterialKind::twosided);
  EXPECT_EQ(s.materials[2].nested[0], 0u);
  EXPECT_EQ(s.materials[2].nested[1], 1u);
  EXPECT_EQ(last(bsdf("twosided", bsdf("diffuse"))).nested[1], none);
  EXPECT_SAYS(error_of(bsdf("twosided")), "needs 1 to 2 nested bsdfs, has 0");
  EXPECT_SAYS(error_of(bsdf("twosided", bsdf("diffuse") + bsdf("diffuse") + bsdf("diffuse"))), "has 3");
  for (const char* type : {"dielectric", "roughdielectric", "thindielectric", "null"})
    EXPECT_SAYS(error_of(bsdf("twosided", bsdf(type))), "lets light through");
  EXPECT_SAYS(error_of(bsdf("twosided", bsdf("mask", bsdf("diffuse")))), "lets light through");
  EXPECT_SAYS(error_of(bsdf("twosided", bsdf("principled", number("spec_trans", 0.5)))), "lets light through");
  EXPECT_EQ(error_of(bsdf("twosided", bsdf("principled"))), "");
}

TEST(Bsdf, Mask) {
  EXPECT_RGB(last(bsdf("mask", bsdf("diffuse"))).weight.value, 0.5, 0.5, 0.5, 0);
  EXPECT_RGB(last(bsdf("mask", bsdf("diffuse") + "<rgb name='opacity' value='.1 .2 .3'/>")).weight.value, 0.1, 0.2, 0.3,
             1e-6);
  EXPECT_NE(last(bsdf("mask", texture("opacity") + bsdf("diffuse"))).weight.texture, none);
  EXPECT_NE(last(bsdf("mask", checker + bsdf("diffuse"))).weight.texture, none);
  EXPECT_SAYS(error_of(bsdf("mask")), "needs 1 nested bsdf, has 0");
}

TEST(Bsdf, Blend) {
  Scene s = load_inside(bsdf("blendbsdf", number("weight", 0.25) + bsdf("diffuse") + bsdf("plastic")));
  EXPECT_EQ(s.materials[2].kind, MaterialKind::blend);
  EXPECT_FLOAT_EQ(s.materials[2].weight.value.x, 0.25f);
  s = load_inside(bsdf("blendbsdf", "<bsdf name='bsdf_1' type='plastic'/><bsdf name='bsdf_0' type='diffuse'/>"));
  EXPECT_EQ(s.materials[s.materials[2].nested[0]].kind, MaterialKind::diffuse);
  const std::string ten = bsdf("blendbsdf", "<bsdf name='b10' type='plastic'/><bsdf name='b2' type='diffuse'/>");
  s = load_inside(ten);
  EXPECT_EQ(s.materials[s.materials[2].nested[0]].kind, MaterialKind::diffuse);
  s = load_inside(ten, {}, "0.6.0");
  EXPECT_EQ(s.materials[s.materials[2].nested[0]].kind, MaterialKind::plastic);
  const auto first = [](const std::string& name, const std::string& version) {  // beside one without a name
    const std::string named = fmt::format("<bsdf name='{}' type='plastic'/>", name);
    const Scene scene = load_inside(bsdf("blendbsdf", named + bsdf("diffuse")), {}, version);
    return scene.materials[scene.materials[2].nested[0]].kind;
  };
  EXPECT_EQ(first("first", "3.0.0"), MaterialKind::diffuse);
  EXPECT_EQ(first("A", "3.0.0"), MaterialKind::plastic);
  for (const char* version : {"0.6.0", "3.7.0", "3.10.1", "4.0.0"})  // as the file has them
    EXPECT_EQ(first("first", version), MaterialKind::plastic) << version;
  for (const char* version : {"2.0.0", "3.6.4", "3"})
    EXPECT_EQ(first("first", version), MaterialKind::diffuse) << version;
  EXPECT_TRUE(says(load_inside(ten).notes, "in the order of their names"));
  EXPECT_FALSE(says(load_inside(ten, {}, "3.7.0").notes, "in the order of their names"));
  EXPECT_SAYS(error_of(bsdf("blendbsdf", bsdf("diffuse"))), "needs 2 nested bsdfs, has 1");
}

// The luminance of red is 0.2126.
TEST(Bsdf, ColoursForNumbersAreAveragedInOldScenes) {
  const std::string red = "<rgb name='color0' value='.9 0 0'/><rgb name='color1' value='.9 0 0'/>";
  const auto red_for = [&](const std::string& name) {
    return fmt::format("<texture name='{}' type='checkerboard'>{}</texture>", name, red);
  };
  for (const bool old : {false, true}) {
    const Scene s = load_inside(bsdf("blendbsdf", red_for("weight") + bsdf("roughconductor", red_for("alpha")) +
                                                      bsdf("phong", red_for("exponent"))),
                                {}, old ? "0.6.0" : "3.0.0");
    for (const Slot& slot : {s.materials[0].alpha_v, s.materials[1].exponent, s.materials[2].weight}) {
      EXPECT_NEAR(eval_scalar(s, slot, {}), old ? 0.3 : 0.9 * 0.2126, 1e-4);
      EXPECT_NEAR(luminance(mean(s, slot)), old ? 0.3 : 0.9 * 0.2126, 1e-4);
    }
  }
}

// As Mitsuba 2 and 3 have it, for all numbers; inner ones too.
TEST(Bsdf, CheckerboardsForNumbersAreExchangedInLaterScenes) {
  const std::string inner =
      "<texture name='color1' type='checkerboard'><transform name='to_uv'><scale x='2' y='2'/>"
      "</transform><float name='color0' value='.3'/><float name='color1' value='.4'/></texture>";
  const auto board = [&](const std::string& name) {
    return fmt::format("<texture name='{}' type='checkerboard'><float name='color0' value='.2'/>{}</texture>", name,
                       inner);
  };
  const std::string text =
      bsdf("roughconductor", board("alpha")) + bsdf("principled", board("metallic")) +
      bsdf("mask", board("opacity") +
                       bsdf("blendbsdf", board("weight") + bsdf("diffuse") + bsdf("diffuse", board("reflectance"))));
  for (const bool old : {false, true}) {
    const Scene s = load_inside(text, {}, old ? "0.6.0" : "3.0.0");
    const auto at = [&](const Slot& slot, float u, float v) {
      Surface surface;
      surface.uv = {u, v};
      return eval_scalar(s, slot, surface);
    };
    for (const Slot& slot : {s.materials[0].alpha_u, s.materials[0].alpha_v, s.materials[1].metallic,
                             s.materials[4].weight, s.materials[5].weight}) {
      EXPECT_FLOAT_EQ(at(slot, 0.75f, 0.25f), old ? 0.3f : 0.2f);
      EXPECT_FLOAT_EQ(at(slot, 0.1f, 0.1f), old ? 0.2f : 0.4f);
      EXPECT_FLOAT_EQ(at(slot, 0.3f, 0.1f), old ? 0.2f : 0.3f);
    }
    EXPECT_FLOAT_EQ(at(s.materials[3].reflectance, 0.1f, 0.1f), 0.2f);
  }
}

TEST(Bsdf, Mixture) {
  Material m = last(bsdf("mixturebsdf", word("weights", "0.3, 0.7") + bsdf("diffuse") + bsdf("plastic")));
  EXPECT_EQ(m.kind, MaterialKind::mixture);
  EXPECT_FLOAT_EQ(m.weights[0], 0.3f);
  EXPECT_FLOAT_EQ(m.weights[1], 0.7f);
  m = last(bsdf("mixturebsdf", word("weights", "0.3; 0.7") + bsdf("diffuse") + bsdf("plastic")));
  EXPECT_FLOAT_EQ(m.weights[1], 0.7f);
  const std::string heavy = word("weights", "1, 3") + bsdf("diffuse") + bsdf("plastic");
  const Scene s = load_inside(bsdf("mixturebsdf", heavy));
  EXPECT_FLOAT_EQ(s.materials[2].weights[0], 0.25f);
  EXPECT_TRUE(says(s.notes, "more than 1"));
  EXPECT_SAYS(error_of(bsdf("mixturebsdf", heavy + "<boolean name='ensureEnergyConservation' value='false'/>")),
              "more than 1");
  EXPECT_SAYS(error_of(bsdf("mixturebsdf", word("weights", "0.5") + bsdf("diffuse") + bsdf("plastic"))), "2 numbers");
  EXPECT_SAYS(error_of(bsdf("mixturebsdf", word("weights", "-0.5") + bsdf("diffuse"))), "negative");
}

TEST(Bsdf, BumpAndNormalMaps) {
  Material m =
      last(bsdf("bumpmap", "<texture name='map' type='checkerboard'/>" + number("scale", 3) + bsdf("diffuse")));
  EXPECT_EQ(m.kind, MaterialKind::bumpmap);
  EXPECT_NE(m.map.texture, none);
  EXPECT_FLOAT_EQ(m.map_scale, 3);
  EXPECT_FLOAT_EQ(last(bsdf("bumpmap", checker + number("scale", 3) + bsdf("diffuse")), {}, "0.6.0").map_scale, 1);
  EXPECT_NE(last(bsdf("bumpmap", checker + bsdf("diffuse"))).map.texture, none);
  const std::string scale = "<texture name='scale' type='checkerboard'/>";
  EXPECT_NE(last(bsdf("bumpmap", scale + bsdf("diffuse")), {}, "0.6.0").map.texture, none);
  EXPECT_NE(last(bsdf("bumpmap", texture("anything") + bsdf("diffuse"))).map.texture, none);
  EXPECT_SAYS(error_of(bsdf("bumpmap", bsdf("diffuse"))), "needs a nested <texture>");
  EXPECT_EQ(last(bsdf("bump", checker + bsdf("diffuse")), {}, "0.4.0").kind, MaterialKind::bumpmap);
  EXPECT_SAYS(error_of(bsdf("bump", checker + bsdf("diffuse"))), "unknown bsdf");
  m = last(bsdf("normalmap", texture("normalmap") + bsdf("diffuse")));
  EXPECT_EQ(m.kind, MaterialKind::normalmap);
  EXPECT_NE(m.map.texture, none);
  const Scene s = load_inside(bsdf("normalmap", word("filename", "four.png") + number("tiles", 4) + bsdf("diffuse")));
  const Scene slopes = load_inside(
      bsdf("normalmap", word("filename", "four.png") + "<boolean name='use_slopes' value='true'/>" + bsdf("diffuse")));
  const Rgb slope = texel(slopes.images.front(), 0, 0), n = texel(slopes.images.back(), 0, 0) * 2.0f - 1.0f;
  EXPECT_NEAR(-n.x / n.z, slope.x, 1e-5);
  EXPECT_NEAR(-n.y / n.z, slope.y, 1e-5);
  EXPECT_NEAR(length2(n), 1, 1e-5);
  const Texture& t = s.textures[s.materials.back().map.texture];
  EXPECT_FLOAT_EQ(t.to_uv[0][0], 4);
  EXPECT_FLOAT_EQ(s.images[t.image].decode[128], 128 / 255.0f);  // raw
  for (const char* map :
       {"<spectrum name='normalmap' type='srgb'><rgb name='color' value='0.5,0.5,1'/></spectrum>",
        "<texture name='normalmap' type='rawconstant'><vector name='value' value='0.5,0.5,1'/></texture>"}) {
    m = last(bsdf("normalmap", map + bsdf("diffuse")));
    EXPECT_EQ(m.map.texture, none);
    EXPECT_RGB(m.map.value, 0.5, 0.5, 1, 0);
  }
  EXPECT_SAYS(error_of(bsdf("normalmap", bsdf("diffuse"))), "needs <texture name=\"normalmap\"");
  EXPECT_NE(last(bsdf("normalmap", texture("normals") + bsdf("diffuse")), {}, "0.6.0").map.texture, none);
  EXPECT_SAYS(error_of(bsdf("normalmap", texture("normals") + bsdf("diffuse"))), "needs <texture");
}

TEST(Bsdf, NullAndRoughDiffuse) {
  EXPECT_EQ(last(bsdf("null")).kind, MaterialKind::null);
  Scene s = load_inside(bsdf("roughdiffuse", "<rgb name='reflectance' value='.2'/>" + number("alpha", 0.3)));
  EXPECT_EQ(s.materials[0].kind, MaterialKind::roughdiffuse);
  EXPECT_RGB(s.materials[0].alpha_u.value, 0.3, 0.3, 0.3, 1e-6);
  EXPECT_FALSE(s.materials[0].simple);
  EXPECT_FALSE(says(s.notes, "bsdf"));
  s = load_inside(bsdf("roughdiffuse", "<boolean name='useFastApprox' value='true'/>"));
  EXPECT_RGB(s.materials[0].alpha_u.value, 0.2, 0.2, 0.2, 1e-6);
  EXPECT_TRUE(s.materials[0].simple);
  EXPECT_FALSE(says(s.notes, "bsdf"));
}

TEST(Bsdf, DiffuseTransmitter) {
  const Material m = last(bsdf("difftrans", "<rgb name='transmittance' value='.1 .2 .3'/>"));
  EXPECT_EQ(m.kind, MaterialKind::difftrans);
  EXPECT_RGB(m.transmittance.value, 0.1, 0.2, 0.3, 1e-6);
  EXPECT_NE(last(bsdf("difftrans", checker)).transmittance.texture, none);
  EXPECT_SAYS(error_of(bsdf("twosided", bsdf("difftrans"))), "lets light through");
}

TEST(Bsdf, Ward) {
  Material m = last(bsdf("ward"));
  EXPECT_EQ(m.kind, MaterialKind::ward);
  EXPECT_EQ(m.ward, WardKind::balanced);
  EXPECT_RGB(m.specular.value, 0.2, 0.2, 0.2, 1e-6);
  EXPECT_RGB(m.alpha_v.value, 0.1, 0.1, 0.1, 1e-6);
  m = last(bsdf("ward", number("alphaU", 0.02) + number("alphaV", 0.3) + word("variant", "ward-duer")));
  EXPECT_EQ(m.ward, WardKind::duer);
  EXPECT_RGB(m.alpha_u.value, 0.02, 0.02, 0.02, 1e-6);
  EXPECT_RGB(m.alpha_v.value, 0.3, 0.3, 0.3, 1e-6);
  EXPECT_EQ(last(bsdf("ward", word("variant", "ward"))).ward, WardKind::ward);
  EXPECT_SAYS(error_of(bsdf("ward", word("variant", "phong"))), "ward-duer");
}

// Polarisation is not simulated: intensities remain.
TEST(Bsdf, Polarised) {
  Scene s = load_inside(bsdf("pplastic", "<rgb name='diffuse_reflectance' value='.1'/>" + number("alpha", 0.06)));
  EXPECT_EQ(s.materials[0].kind, MaterialKind::roughplastic);
  EXPECT_EQ(s.materials[0].inner, Inner::lost);
  EXPECT_RGB(s.materials[0].alpha_u.value, 0.06, 0.06, 0.06, 1e-6);
  EXPECT_RGB(s.materials[0].alpha_v.value, 0.06, 0.06, 0.06, 1e-6);
  EXPECT_FLOAT_EQ(last(bsdf("pplastic", number("alpha_v", 0.3))).alpha_v.value.x, 0.3f);
  EXPECT_TRUE(says(s.notes, "not polarised"));
  s = load_inside(bsdf("polarizer", "<spectrum name='theta' value='90'/><rgb name='transmittance' value='.8'/>"));
  EXPECT_EQ(s.materials[0].kind, MaterialKind::thindielectric);
  EXPECT_EQ(s.materials[0].ior, 1);
  EXPECT_RGB(s.materials[0].transmittance.value, 0.4, 0.4, 0.4, 1e-6);
  EXPECT_TRUE(says(s.notes, "half of it passes"));
  EXPECT_FALSE(says(s.notes, "no effect"));
  s = load_inside(bsdf("retarder", "<spectrum name='theta' value='90'/><spectrum name='delta' value='90'/>"));
  EXPECT_EQ(s.materials[0].kind, MaterialKind::thindielectric);
  EXPECT_EQ(s.materials[0].ior, 1);
  EXPECT_RGB(s.materials[0].transmittance.value, 1, 1, 1, 0);
  EXPECT_FALSE(says(s.notes, "not used"));
  s = load_inside(bsdf("circular", "<boolean name='left_handed' value='true'/>"));
  EXPECT_RGB(s.materials[0].transmittance.value, 0.5, 0.5, 0.5, 1e-6);
  EXPECT_FALSE(says(s.notes, "not used"));
  s = load_inside(bsdf("polarizer", texture("transmittance")));
  ASSERT_NE(s.materials[0].transmittance.texture, none);
  EXPECT_RGB(eval(s, s.materials[0].transmittance, Surface()), 0.2, 0.2, 0.2, 1e-6);  // half of color0
}

TEST(Bsdf, UnknownOnes) {
  for (const char* type : {"coating", "roughcoating", "hk", "hair", "disneybsdf", "principledthin"}) {
    EXPECT_SAYS(error_of(fmt::format("\n{}", bsdf(type))),
                "test.xml:3: <bsdf type=\"" + std::string(type) + "\">: unknown bsdf");
    EXPECT_EQ(last(bsdf(type), lenient()).kind, MaterialKind::diffuse);
    EXPECT_EQ(last(bsdf(type, bsdf("plastic")), lenient()).kind, MaterialKind::plastic);
  }
  EXPECT_TRUE(says(load_inside(bsdf("hk"), lenient()).notes, "grey diffuse in its place"));
}

TEST(Bsdf, WhatCannotBeEvaluatedIsNamed) {
  std::string many = bsdf("diffuse");
  for (int i = 0; i < 4; ++i) many = bsdf("blendbsdf", many + bsdf("plastic"));
  EXPECT_SAYS(error_of(fmt::format("\n{}", many)), "test.xml:3: <bsdf type=\"blendbsdf\">: it adds up to 5");
  const Scene s = load_inside(many, lenient());
  EXPECT_EQ(s.materials.back().kind, MaterialKind::plastic);  // read, then the first of both took the blend's place
}

TEST(Bsdf, PartsOfABlendMayBendTheNormal) {
  const std::string bent = bsdf("blendbsdf", bsdf("diffuse") + bsdf("bumpmap", checker + bsdf("plastic")));
  EXPECT_EQ(last(bent).kind, MaterialKind::blend);
  EXPECT_TRUE(last(bent).splits);
}

// Mitsuba 3.7.1 folds bent normals back, and shades what they turn away; before, and with false, it does not.
TEST(Bsdf, FoldedNormalsAreToldOf) {
  const auto notes = [](const std::string& type, const std::string& inside) {
    return load_inside("<bsdf type='" + type +
                       "'><texture name='normalmap' type='checkerboard'/><bsdf type='diffuse'/>" + inside + "</bsdf>")
        .notes;
  };
  const std::string flip = "<boolean name='flip_invalid_normals' value='", shade =
                                                                               "<boolean name='use_shadowing_function' "
                                                                               "value='";
  const std::string on = "true'/>", off = "false'/>", words = "normals are bent as in Mitsuba up to 3.7.0";
  for (const std::string type : {"bumpmap", "normalmap"}) {
    for (const std::string& inside : {std::string(), flip + off, flip + off + shade + off}) {
      EXPECT_FALSE(says(notes(type, inside), words)) << inside;
      EXPECT_FALSE(says(notes(type, inside), "not used")) << inside;
    }
    EXPECT_TRUE(says(notes(type, flip + on), "flip_invalid_normals is not supported: " + words));
    EXPECT_TRUE(says(notes(type, flip + off + shade + on), "use_shadowing_function is not supported: " + words));
    int count = 0;
    for (const std::string& note : notes(type, flip + on + shade + on)) count += note.find("_normals") != note.npos;
    EXPECT_EQ(count, 1);
  }
}

}  // namespace
}  // namespace ajar
