// Numbers and spectra become linear RGB.
#include "scene/load/loader.h"
#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

// The colour as a reflectance and as a radiance.
Rgb reflectance(const std::string& element) {
  return load_inside("<bsdf type='diffuse'>" + element + "</bsdf>").materials[0].reflectance.value;
}
Rgb radiance(const std::string& element) {
  return load_inside("<emitter type='constant'>" + element + "</emitter>").lights[0].radiance.value;
}
std::string flat(const std::string& value) { return "<spectrum name='radiance' value='" + value + "'/>"; }

TEST(Numbers, AreReadWhollyOrNotAtAll) {
  EXPECT_EQ(to_number("1.42138e-007"), 1.42138e-7);
  EXPECT_EQ(to_number(" +.5 "), 0.5);
  EXPECT_EQ(to_number("1."), 1.0);
  EXPECT_EQ(to_number("-0"), -0.0);
  EXPECT_EQ(to_number("1e-999"), 0.0);
  for (const char* text : {"", " ", "1,5", "1 2", "nan", "inf", "-inf", "1e999", "0x10", "1.0f", "--1", "e5", "++1"})
    EXPECT_FALSE(to_number(text)) << text;
  EXPECT_EQ(to_numbers("1, 2 3,4\n\t5")->size(), 5u);
  EXPECT_EQ(to_numbers("")->size(), 0u);
  EXPECT_FALSE(to_numbers("1, x"));
}

// As C and shaders write them, and as some files do that Mitsuba does not read either.
TEST(Numbers, SuffixesAreToldFrom) {
  const std::string cure = ": leave out the f, which Mitsuba does not take either";
  const auto bsdf = [](const std::string& inside) { return "<bsdf type='diffuse'>" + inside + "</bsdf>"; };
  for (const std::string& inside :
       {bsdf("<float name='reflectance' value='0.5f'/>"), bsdf("<rgb name='reflectance' value='1, 0.5f, 0'/>"),
        bsdf("<spectrum name='reflectance' value='400:1.f, 500:1'/>"),
        std::string("<shape type='sphere'><float name='radius' value='1.0f'/></shape>"),
        std::string("<shape type='sphere'><point name='center' value='0, 0, 1f'/></shape>"),
        std::string("<shape type='cube'><transform name='toWorld'><translate x='2f'/></transform></shape>"),
        std::string("<shape type='cube'><transform name='toWorld'><lookat origin='0 0 1f' target='0 0 0'/></transform>"
                    "</shape>"),
        std::string("<shape type='cube'><transform name='toWorld'><matrix value='1f 0 0 0 1 0 0 0 1'/></transform>"
                    "</shape>")})
    EXPECT_SAYS(error_of(inside), cure);
  EXPECT_EQ(error_of("<shape type='sphere'><float name='radius' value='half'/></shape>").find("leave out"),
            std::string::npos);
}

TEST(Colour, RgbForms) {
  EXPECT_RGB(reflectance("<rgb name='reflectance' value='0.1, 0.2 0.3'/>"), 0.1, 0.2, 0.3, 1e-6);
  EXPECT_RGB(reflectance("<rgb name='reflectance' value='0.25'/>"), 0.25, 0.25, 0.25, 1e-6);
  EXPECT_RGB(reflectance("<rgb name='reflectance' value='#ff0080'/>"), 1, 0, 128 / 255.0, 1e-6);
  EXPECT_RGB(reflectance("<srgb name='reflectance' value='#ff0080'/>"), 1, 0, 0.215861, 1e-5);
  EXPECT_RGB(reflectance("<srgb name='reflectance' value='0.5, 0, 1'/>"), 0.214041, 0, 1, 1e-5);
  EXPECT_RGB(reflectance("<spectrum name='reflectance' value='0.3'/>"), 0.3, 0.3, 0.3, 1e-6);
  EXPECT_RGB(reflectance("<spectrum name='reflectance' value='0.3, 0.2, 0.1'/>"), 0.3, 0.2, 0.1, 1e-6);
  EXPECT_RGB(reflectance("<float name='reflectance' value='0.4'/>"), 0.4, 0.4, 0.4, 1e-6);
}

TEST(Colour, ReferenceToAColour) {
  EXPECT_RGB(load_inside("<spectrum id='c' value='0.3'/><bsdf type='diffuse'><ref name='reflectance' id='c'/></bsdf>")
                 .materials[0]
                 .reflectance.value,
             0.3, 0.3, 0.3, 1e-6);
}

TEST(Colour, FlatSpectrumIsGrey) {
  EXPECT_RGB(reflectance("<spectrum name='reflectance' value='300:0.42, 900:0.42'/>"), 0.42, 0.42, 0.42, 1e-6);
  EXPECT_RGB(reflectance("<spectrum name='reflectance' filename='flat.spd'/>"), 0.25, 0.25, 0.25, 1e-6);
  const std::string marked = write_file("marked.spd", std::string("\xef\xbb\xbf") + "300 0.5\r\n900 0.5\r\n");
  EXPECT_RGB(reflectance("<spectrum name='reflectance' filename='" + marked + "'/>"), 0.5, 0.5, 0.5, 1e-6);
  EXPECT_NEAR(luminance(radiance(flat("300:3, 900:3"))), 3, 2e-3);
}

TEST(Colour, EqualEnergyLightIsWarm) {  // E in sRGB: XYZ (1, 1, 1)
  EXPECT_RGB(radiance(flat("300:1, 900:1")), 1.2048, 0.9484, 0.9087, 4e-3);
}

// Zero outside; in Mitsuba 0.x at the mean distance of the wavelengths.
TEST(Colour, ListsEnd) {
  const auto light = [](const std::string& list, const std::string& version) {
    return load_inside("<emitter type='constant'><spectrum name='radiance' value='" + list + "'/></emitter>", {},
                       version)
        .lights[0]
        .radiance.value;
  };
  EXPECT_RGB(light("500:1, 600:1", "3.0.0"), 0.269, 0.989, 0, 2e-3);
  EXPECT_RGB(light("500:1, 600:1", "0.6.0"), 0.920, 1.008, 0.417, 2e-3);
  EXPECT_EQ(light("600:1, 500:1", "0.6.0"), light("400:0, 500:1, 600:1, 700:0", "0.6.0"));
  EXPECT_EQ(light("400:0, 500:1, 600:0", "0.6.0"), light("400:0, 500:1, 600:0", "0.5.0"));
  const std::string wide = write_file("wide.spd", "300 0.5 7\n900 0.5 7\n");
  EXPECT_RGB(reflectance("<spectrum name='reflectance' filename='" + wide + "'/>"), 0.5, 0.5, 0.5, 1e-6);
}

// As the list that it stands for, as in Mitsuba 3, whose documents tell of it; white in version 0.x.
TEST(Colour, NumberInASpectrumIsAFlatLight) {
  const auto light = [](const std::string& type, const std::string& inside, const std::string& version = "3.0.0") {
    return load_inside("<emitter type='" + type + "'>" + inside + "</emitter>", {}, version).lights[0].radiance.value;
  };
  const auto spectrum = [](const std::string& name) { return "<spectrum name='" + name + "' value=' 2 '/>"; };
  for (const auto& [type, name] : {std::pair("constant", "radiance"),
                                   {"point", "intensity"},
                                   {"spot", "intensity"},
                                   {"directional", "irradiance"}})
    EXPECT_RGB(light(type, spectrum(name)), 2.4096, 1.8968, 1.8174, 8e-3);
  constexpr double pi = 3.14159265;
  EXPECT_RGB(light("projector", spectrum("irradiance")) / float(pi), 2.4096, 1.8968, 1.8174, 8e-3);
  const Scene scene = load_inside("<shape type='sphere'><emitter type='area'>" + spectrum("radiance") +
                                  "</emitter></shape><shape type='sphere'><emitter type='area'><spectrum "
                                  "name='radiance' type='uniform'><float name='value' value='2'/></spectrum></emitter>"
                                  "</shape>");
  EXPECT_RGB(scene.lights[0].radiance.value, 2.4096, 1.8968, 1.8174, 8e-3);
  EXPECT_RGB(scene.lights[1].radiance.value, 2, 2, 2, 1e-6);
  EXPECT_RGB(light("constant", spectrum("radiance"), "0.6.0"), 2, 2, 2, 1e-6);
  EXPECT_RGB(light("constant", "<rgb name='radiance' value='2'/>"), 2, 2, 2, 1e-6);
  EXPECT_RGB(light("constant", "<float name='radiance' value='2'/>"), 2, 2, 2, 1e-6);
  EXPECT_RGB(light("constant", "<spectrum name='radiance' value='1, 2, 3'/>"), 1, 2, 3, 1e-6);
}

// XYZ (1, 1, 1) of surfaces too, as in Mitsuba 0.6; a white wall, whose red is more than there can be, is scaled.
TEST(Colour, ListsOfTheOlderVersionAreSeenUnderEqualEnergy) {
  const auto material = [](const std::string& type, const std::string& inside) {
    return load_inside("<bsdf type='" + type + "'>" + inside + "</bsdf>", {}, "0.6.0").materials[0];
  };
  const std::string half = "<spectrum name='reflectance' value='300:.5, 900:.5'/>";
  EXPECT_RGB(material("diffuse", half).reflectance.value, 0.6024, 0.4742, 0.4544, 2e-3);
  EXPECT_RGB(material("diffuse", "<spectrum name='reflectance' filename='flat.spd'/>").reflectance.value, 0.3012,
             0.2371, 0.2272, 1e-3);
  EXPECT_RGB(material("diffuse", "<spectrum name='reflectance' value='300:1, 900:1'/>").reflectance.value, 0.99, 0.7793,
             0.7467, 4e-3);
  EXPECT_RGB(material("diffuse", "<spectrum name='reflectance' value='.5'/>").reflectance.value, 0.5, 0.5, 0.5, 1e-6);
  EXPECT_RGB(
      material("conductor", "<string name='extEta' value='vacuum'/><spectrum name='eta' value='300:2, 900:2'/>").eta,
      2.4096, 1.8968, 1.8174, 8e-3);
}

TEST(Colour, ListIsLinearBetweenAndZeroOutside) {
  EXPECT_RGB(rgb_of_list({{700, 0}, {400, 0}, {550, 1}}, Colour::ratio),  // sorted first
             rgb_of_list({{400, 0}, {475, 0.5}, {550, 1}, {625, 0.5}, {700, 0}}, Colour::ratio).x,
             rgb_of_list({{400, 0}, {475, 0.5}, {550, 1}, {625, 0.5}, {700, 0}}, Colour::ratio).y,
             rgb_of_list({{400, 0}, {475, 0.5}, {550, 1}, {625, 0.5}, {700, 0}}, Colour::ratio).z, 1e-5);
  const Rgb left = rgb_of_list({{300, 1}, {555, 1}}, Colour::ratio),
            right = rgb_of_list({{555.0001, 1}, {900, 1}}, Colour::ratio);
  EXPECT_RGB(left + right, 1, 1, 1, 1e-4);
  EXPECT_RGB(rgb_of_list({{100, 1}, {200, 1}}, Colour::ratio), 0, 0, 0, 0);
}

// Expected values from the analytic colour matching functions of Wyman et al. 2013 and a coarser D65; without D65 red
// would be 0.183.
TEST(Colour, SurfacesAreSeenUnderD65) {
  EXPECT_RGB(rgb_of_list({{300, 1}, {600, 1}}, Colour::ratio), 0.156, 1.035, 1.013, 0.015);
}

// The Cornell box's walls (Cornell University Program of Computer Graphics, 1998), in the coarse form that scene files
// have, against the RGB values that they are usually given.
TEST(Colour, CornellBoxWalls) {
  EXPECT_RGB(
      reflectance("<spectrum name='reflectance' value='400:0.343, 404:0.445, 408:0.551, 412:0.624, 416:0.665, "
                  "420:0.687, 424:0.708, 428:0.723, 432:0.715, 436:0.71, 440:0.745, 444:0.758, 448:0.739, 452:0.767, "
                  "456:0.777, 460:0.765, 500:0.74, 550:0.72, 600:0.73, 650:0.74, 700:0.737'/>"),
      0.725, 0.71, 0.70, 0.05);
  const Rgb red = reflectance(
      "<spectrum name='reflectance' value='400:0.04, 500:0.06, 570:0.05, 600:0.3, 620:0.53, 650:0.63, "
      "700:0.64'/>");
  EXPECT_GT(red.x, 6 * red.y);
  EXPECT_GT(red.x, 6 * red.z);
}

TEST(Colour, BlackBody) {
  // 6504 K is nearly the white of D65, but less green; Planck's law at 555 nm and 5000 K: 1.1e4 W/(m^2 sr nm)
  const Rgb white = rgb_of_blackbody(6504);
  EXPECT_NEAR(white.x / white.y, 1, 0.08);
  EXPECT_NEAR(white.z / white.y, 1, 0.08);
  EXPECT_NEAR(luminance(rgb_of_blackbody(5000)), 1.24e4, 0.08e4);
  const Rgb warm = rgb_of_blackbody(2700);
  EXPECT_GT(warm.x, 3 * warm.z);
  EXPECT_RGB(
      radiance("<blackbody name='radiance' temperature='5000K' scale='1e-4'/>") / (rgb_of_blackbody(5000) * 1e-4f), 1,
      1, 1, 1e-5);
  EXPECT_RGB(
      radiance("<spectrum name='radiance' type='blackbody'><float name='temperature' value='5000'/></spectrum>") /
          rgb_of_blackbody(5000),
      1, 1, 1, 1e-5);
}

TEST(Colour, SpectrumPlugins) {
  const auto plugin = [](const std::string& type, const std::string& inside) {
    return "<spectrum name='reflectance' type='" + type + "'>" + inside + "</spectrum>";
  };
  EXPECT_RGB(reflectance(plugin("uniform", "<float name='value' value='.3'/>")), 0.3, 0.3, 0.3, 1e-6);
  EXPECT_RGB(reflectance(plugin("srgb", "<rgb name='color' value='.1 .2 .3'/>")), 0.1, 0.2, 0.3, 1e-6);
  EXPECT_RGB(reflectance(plugin("rawconstant", "<rgb name='value' value='.1 .2 .3'/>")), 0.1, 0.2, 0.3, 1e-6);
  EXPECT_RGB(reflectance(plugin("rawconstant", "<vector name='value' x='.1' y='.2' z='.3'/>")), 0.1, 0.2, 0.3, 1e-6);
  EXPECT_RGB(reflectance(plugin("d65", "<float name='scale' value='.5'/>")), 0.5, 0.5, 0.5, 1e-6);
  const std::string tint = "<spectrum type='srgb'><rgb name='color' value='.1 .2 .3'/></spectrum>";
  const std::string scaled = "<float name='scale' value='.5'/>";
  EXPECT_RGB(reflectance(plugin("d65", tint + scaled)), 0.1, 0.2, 0.3, 1e-6);  // not scaled, as in Mitsuba
  EXPECT_RGB(reflectance(plugin("d65", "<spectrum type='d65'>" + tint + "</spectrum>")), 0.1, 0.2, 0.3, 1e-6);
  EXPECT_RGB(reflectance("<spectrum type='uniform' id='t'><float name='value' value='.3'/></spectrum>" +
                         plugin("d65", "<ref id='t'/>")),
             0.3, 0.3, 0.3, 1e-6);
  EXPECT_NE(load_inside("<shape type='sphere'><emitter type='area'><spectrum name='radiance' type='d65'><texture "
                        "type='checkerboard'/></spectrum></emitter></shape>")
                .lights[0]
                .radiance.texture,
            none);
  EXPECT_RGB(reflectance(plugin("irregular",
                                "<string name='wavelengths' value='300, 900'/>"
                                "<string name='values' value='.5, .5'/>")),
             0.5, 0.5, 0.5, 1e-6);
  EXPECT_RGB(reflectance(plugin("regular",
                                "<float name='wavelength_min' value='300'/><float name='wavelength_max' value='900'/>"
                                "<string name='values' value='.5, .5'/>")),
             0.5, 0.5, 0.5, 1e-6);
}

// <texture> and <spectrum> are one to Mitsuba 3.
TEST(Colour, WhatALightShowsIsATextureOrASpectrum) {
  const auto light = [](const std::string& tag, const std::string& inside) {
    return load_inside("<shape type='sphere'><emitter type='area'><" + tag + " name='radiance' type='d65'>" + inside +
                       "</" + tag + "></emitter></shape>")
        .lights[0]
        .radiance;
  };
  for (const std::string tag : {"spectrum", "texture"}) {
    EXPECT_NE(light(tag, "<texture type='checkerboard'/>").texture, none) << tag;
    for (const std::string inner : {"spectrum", "texture"})
      EXPECT_RGB(light(tag, "<" + inner + " type='srgb'><rgb name='color' value='.1 .2 .3'/></" + inner + ">").value,
                 0.1, 0.2, 0.3, 1e-6);
    EXPECT_RGB(light(tag, "").value, 1, 1, 1, 1e-6);
  }
}

TEST(Colour, ElementsAsPlugins) {
  const auto plugin = [](const std::string& tag, const std::string& name, const std::string& type,
                         const std::string& inside) {
    return "<" + tag + " name='" + name + "' type='" + type + "'>" + inside + "</" + tag + ">";
  };
  const std::string three = "<rgb name='value' value='.1 .2 .3'/>", one = "<float name='value' value='.5'/>",
                    list = "<spectrum name='value' value='300:.5, 900:.5'/>",
                    file = "<string name='filename' value='flat.spd'/>";
  for (const std::string tag : {"spectrum", "texture"}) {
    EXPECT_RGB(reflectance(plugin(tag, "reflectance", "rgb", three)), 0.1, 0.2, 0.3, 1e-6);
    EXPECT_RGB(reflectance(plugin(tag, "reflectance", "spectrum", one)), 0.5, 0.5, 0.5, 1e-6);
    EXPECT_RGB(reflectance(plugin(tag, "reflectance", "spectrum", list)), 0.5, 0.5, 0.5, 1e-6);
    EXPECT_RGB(reflectance(plugin(tag, "reflectance", "spectrum", file)), 0.25, 0.25, 0.25, 1e-6);
    EXPECT_RGB(radiance(plugin(tag, "radiance", "rgb", three)), 0.1, 0.2, 0.3, 1e-6);
    // as <spectrum value=>: of the tint of equal energy, a number too
    for (const std::string& inside : {one, list})
      EXPECT_RGB(radiance(plugin(tag, "radiance", "spectrum", inside)), 0.6024, 0.4742, 0.4544, 2e-3);
  }
  const auto error = [&](const std::string& type) {
    return error_of("<bsdf type='diffuse'>" + plugin("texture", "reflectance", type, "") + "</bsdf>");
  };
  EXPECT_SAYS(error("rgb"), "needs <rgb name=\"value\" value=\"...\"/>");
  EXPECT_SAYS(error("spectrum"), "needs <spectrum name=\"value\" value=\"...\"/>");
}

TEST(Colour, TablesInOneSpectrum) {
  for (const std::string type : {"regular", "irregular"})
    EXPECT_RGB(reflectance("<spectrum name='reflectance' type='" + type +
                           "'><spectrum name='value' value='300:.3, 600:.3, 900:.3'/></spectrum>"),
               0.3, 0.3, 0.3, 1e-6);
}

// As Mitsuba's manual writes it.
TEST(Colour, RangeOfARegularSpectrum) {
  const auto regular = [](const std::string& range) {
    return "<spectrum name='reflectance' type='regular'><string name='values' value='.1, .5'/>" + range + "</spectrum>";
  };
  const std::string ends = "<float name='wavelength_min' value='400'/><float name='wavelength_max' value='600'/>";
  const Rgb expected = reflectance(regular(ends));
  EXPECT_RGB(reflectance(regular("<string name='range' value='400, 600'/>")), expected.x, expected.y, expected.z, 1e-6);
  EXPECT_SAYS(error_of("<bsdf type='diffuse'>" + regular("<string name='range' value='400'/>") + "</bsdf>"),
              "range \"400\" should be two wavelengths");
}

TEST(Colour, ImpossibleOnesAreRepairedAloud) {
  Scene s = load_inside("<bsdf type='diffuse'><rgb name='reflectance' value='-0.1, 0.5, 2'/></bsdf>");
  EXPECT_RGB(s.materials[0].reflectance.value, 0, 0.5, 1, 1e-6);
  EXPECT_TRUE(says(s.notes, "negative"));
  EXPECT_TRUE(says(s.notes, "reflectance above 1"));
  s = load_inside("<bsdf type='diffuse'><rgb name='reflectance' value='0.1, 0.5, 2'/></bsdf>", {}, "0.6.0");
  EXPECT_RGB(s.materials[0].reflectance.value, 0.0495, 0.2475, 0.99, 1e-6);
  EXPECT_TRUE(says(s.notes, "scaled to 0.99"));
  EXPECT_RGB(radiance("<rgb name='radiance' value='100, 20, 3'/>"), 100, 20, 3, 1e-6);
}

TEST(Colour, WrongOnesAreErrors) {
  const auto error = [](const std::string& element) { return error_of("<bsdf type='diffuse'>" + element + "</bsdf>"); };
  EXPECT_SAYS(error("<rgb name='reflectance' value='1, 2'/>"), "should be one number, three or #rrggbb");
  EXPECT_SAYS(error("<rgb name='reflectance' value='#12345'/>"), "#rrggbb");
  EXPECT_SAYS(error("<rgb name='reflectance' value='#12345g'/>"), "#rrggbb");
  EXPECT_SAYS(error("<rgb name='reflectance'/>"), "needs value");
  EXPECT_SAYS(error("<rgb name='reflectance' value='nan'/>"), "should be one number");
  EXPECT_SAYS(error("<rgb name='reflectance' value='1e39'/>"), "beyond the range");
  EXPECT_SAYS(error("<spectrum name='reflectance' value='400:, 500:1'/>"), "wavelength:value");
  EXPECT_SAYS(error("<spectrum name='reflectance' value='-5:1'/>"), "out of range");
  EXPECT_SAYS(error("<spectrum name='reflectance' filename='none.spd'/>"), "there is no file");
  EXPECT_SAYS(error("<spectrum name='reflectance' filename='empty.obj'/>"), "holds no wavelengths");
  EXPECT_SAYS(error("<spectrum name='reflectance' filename='fragment.xml'/>"), "fragment.xml:1: \"<");
  EXPECT_SAYS(error("<spectrum name='reflectance' filename='fragment.xml'/>"), "should be a wavelength and a value");
  EXPECT_SAYS(error("<blackbody name='reflectance' temperature='-1'/>"), "temperature");
  EXPECT_SAYS(error("<point name='reflectance' x='1'/>"), "is expected here");
}

TEST(Colour, LightOfOneThingAlone) {
  const auto error = [](const std::string& inside) {
    return error_of("<emitter type='constant'><spectrum name='radiance' type='d65' id='l'>" + inside +
                    "</spectrum></emitter>");
  };
  const std::string flat_one = "<spectrum type='uniform'/>";
  EXPECT_SAYS(error("<rgb name='color' value='1'/>" + flat_one), "has both a color and a texture or spectrum");
  EXPECT_SAYS(error(flat_one + flat_one), "is the second texture or spectrum in a d65");
  EXPECT_SAYS(error("<texture type='checkerboard'/>"), "has to be one colour here, not a texture");
  EXPECT_SAYS(error("<ref id='l'/>"), "contains itself");
}

TEST(Colour, NamesOfSubstances) {
  EXPECT_EQ(find_dielectric("BK7"), 1.5046);
  EXPECT_EQ(find_dielectric("water_ice"), 1.31);
  EXPECT_FALSE(find_dielectric("porridge"));
  ASSERT_NE(find_metal("Au"), nullptr);
  EXPECT_RGB(find_metal("Au")->eta, 0.143, 0.375, 1.4425, 1e-3);
  EXPECT_EQ(find_metal("none")->k, Rgb(1));
  EXPECT_EQ(find_metal("Unobtainium"), nullptr);
}

// Wavelengths in micrometres, or too close together to be met.
TEST(Colour, WhatCannotBeSeenIsTold) {
  const auto notes = [](const std::string& value) {
    return load_inside("<bsdf type='diffuse'><spectrum name='reflectance' value='" + value + "'/></bsdf>").notes;
  };
  for (const char* value : {"0.4:1, 0.7:1", "900:1, 1000:1", "500.01:1, 500.02:1", "500:1"})
    EXPECT_TRUE(says(notes(value), "<spectrum name=\"reflectance\">: black, since nothing of it can be seen")) << value;
  for (const char* value : {"400:0, 700:0", "400:1, 700:1"}) EXPECT_FALSE(says(notes(value), "can be seen")) << value;
}

TEST(Colour, NumbersBeyondTheirRangeAreTold) {
  const Scene s = load_inside(
      "<bsdf type='blendbsdf'><float name='weight' value='5'/><bsdf type='principled'><float name='metallic' "
      "value='2'/></bsdf><bsdf type='roughplastic'><float name='alpha' value='-1'/></bsdf></bsdf>");
  EXPECT_TRUE(says(s.notes, "<float name=\"weight\">: a number above 1 where a share is meant: it was set to 1"));
  EXPECT_TRUE(says(s.notes, "<float name=\"metallic\">: a number above 1 where a share is meant: it was set to 1"));
  EXPECT_TRUE(says(s.notes, "<float name=\"alpha\">: a negative number: it was set to 0"));
  EXPECT_TRUE(says(s.notes, "<bsdf type=\"roughplastic\">: alpha is rendered as 0.0001"));
  EXPECT_SAYS(error_of("<bsdf type='diffuse'><spectrum name='reflectance' type='wild'/></bsdf>"),
              "unknown spectrum; supported: uniform, d65");
}

// The names that Mitsuba's documentation lists, each in the spellings with and without _palik that occur.
TEST(Colour, AllMetalsOfMitsubaAreKnown) {
  for (const char* name :
       {"a-C",        "Ag",       "Al",         "AlAs",     "AlAs_palik", "AlSb",     "AlSb_palik", "Au",
        "Be",         "Be_palik", "Cr",         "CsI",      "CsI_palik",  "Cu",       "Cu_palik",   "Cu2O",
        "Cu2O_palik", "CuO",      "CuO_palik",  "d-C",      "d-C_palik",  "Hg",       "Hg_palik",   "HgTe",
        "HgTe_palik", "Ir",       "Ir_palik",   "K",        "K_palik",    "Li",       "Li_palik",   "MgO",
        "MgO_palik",  "Mo",       "Mo_palik",   "Na_palik", "Nb",         "Nb_palik", "Ni_palik",   "Rh",
        "Rh_palik",   "Se",       "Se_palik",   "SiC",      "SiC_palik",  "SnTe",     "SnTe_palik", "Ta",
        "Ta_palik",   "Te",       "Te_palik",   "ThF4",     "ThF4_palik", "TiC",      "TiC_palik",  "TiN",
        "TiN_palik",  "TiO2",     "TiO2_palik", "VC",       "VC_palik",   "V_palik",  "VN",         "VN_palik",
        "W",          "W_palik",  "none"})
    EXPECT_NE(find_metal(name), nullptr) << name;
}

// Wavelength [um], n and k of Zollner et al. 1989, table of their measurement at 300 K.
TEST(Colour, AlSbIsWhatWasMeasured) {
  constexpr double measured[][3] = {
      {0.3542, 3.95, 2.69},   {0.3647, 3.97, 2.64},  {0.3757, 4.14, 2.69},  {0.3875, 4.51, 2.47},
      {0.3999, 4.57, 2.12},   {0.4133, 4.52, 1.97},  {0.4275, 4.66, 2.06},  {0.4428, 5.27, 1.58},
      {0.4592, 5.08, 0.92},   {0.4769, 4.81, 0.63},  {0.4959, 4.61, 0.46},  {0.5166, 4.44, 0.33},
      {0.5391, 4.31, 0.24},   {0.5636, 4.20, 0.01},  {0.5904, 4.01, 0.006}, {0.6199, 3.90, 0.004},
      {0.6525, 3.81, 0.003},  {0.6888, 3.73, 0.002}, {0.7293, 3.66, 0.001}, {0.7749, 3.60, 0.0003},
      {0.8266, 3.54, 0.0002}, {0.8856, 3.50, 0.0001}};
  std::vector<std::pair<double, double>> n, k;
  for (const auto& row : measured) n.emplace_back(1000 * row[0], row[1]), k.emplace_back(1000 * row[0], row[2]);
  const Metal& metal = *find_metal("AlSb");
  const Rgb eta = rgb_of_list(n, Colour::emission), extinction = rgb_of_list(k, Colour::emission);
  EXPECT_RGB(metal.eta, eta.x, eta.y, eta.z, 1e-3);
  EXPECT_RGB(metal.k, std::max(extinction.x, 0.0f), extinction.y, extinction.z, 1e-3);
}

}  // namespace
}  // namespace ajar
