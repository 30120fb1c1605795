// Names, parameters, includes, references: what happens before a plugin is looked at.
#include <filesystem>
#include <fstream>

#include "scene/load/node.h"
#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

const std::string ball = "<shape type='sphere'><ref id='m'/></shape>";

float grey(const Scene& scene) { return scene.materials[scene.shapes.at(0).material].reflectance.value.x; }

LoadOptions define(const std::string& name, const std::string& value) {
  LoadOptions options;
  options.defines[name] = value;
  return options;
}

TEST(Names, BothSpellingsAreOne) {
  const std::pair<const char*, const char*> names[] = {{"toWorld", "to_world"},
                                                       {"to_world", "to_world"},
                                                       {"intIOR", "int_ior"},
                                                       {"extIOR", "ext_ior"},
                                                       {"alphaU", "alpha_u"},
                                                       {"cropOffsetX", "crop_offset_x"},
                                                       {"diffuseReflectance", "diffuse_reflectance"},
                                                       {"p0", "p0"},
                                                       {"color0", "color0"},
                                                       {"toUV", "to_uv"},
                                                       {"sigmaA", "sigma_a"},
                                                       {"Rectangle", "rectangle"},
                                                       {"", ""},
                                                       {"principalPointOffsetX", "principal_point_offset_x"}};
  for (const auto& [theirs, ours] : names) EXPECT_EQ(snake_case(theirs), ours);
}

TEST(Names, MayBeMixedInOneElement) {
  const Scene s = load_inside(
      "<bsdf type='roughplastic' id='m'><float name='intIOR' value='1.6'/><float name='ext_ior' value='1'/>"
      "<rgb name='diffuseReflectance' value='.1 .2 .3'/><rgb name='specular_reflectance' value='.5'/></bsdf>" +
      ball);
  const Material& m = s.materials[0];
  EXPECT_FLOAT_EQ(m.ior, 1.6f);
  EXPECT_RGB(m.reflectance.value, 0.1, 0.2, 0.3, 1e-6);
  EXPECT_RGB(m.specular.value, 0.5, 0.5, 0.5, 1e-6);
}

// Mitsuba 0.6 knows toWorld alone; 2 and 3 read older files by new names, not by old rules.
TEST(Names, ToWorldIsOfVersion2) {
  const auto scene = [](const std::string& name) {
    return load_scene_text(
        "<scene version='0.5.0'>\n<sensor type='perspective'/><sensor type='orthographic'/>\n"
        "<bsdf type='roughconductor' id='metal'/>\n"
        "<bsdf type='roughplastic' id='m'><spectrum name='diffuseReflectance' value='300:.5, 900:.5'/>"
        "<float name='intIOR' value='1.6'/><float name='extIOR' value='1'/></bsdf>\n"
        "<shape type='sphere'><ref id='m'/><transform name='" +
            name + "'><translate x='3'/></transform></shape></scene>",
        assets(), "test.xml", {});
  };
  const std::string told = "test.xml:5: version 0.5.0 does not know to_world: read as a scene of version 2";
  const Scene older = scene("toWorld");
  EXPECT_EQ(older.camera.kind, CameraKind::orthographic);       // the last
  EXPECT_RGB(older.materials[0].eta, 0.2, 0.924, 1.102, 1e-2);  // of copper in air
  EXPECT_GT(older.materials[1].reflectance.value.x, 0.55f);     // under equal energy
  EXPECT_TRUE(says(older.notes, "sun and sky were added"));
  EXPECT_FALSE(says(older.notes, "to_world"));
  const Scene later = scene("to_world");
  EXPECT_EQ(later.camera.kind, CameraKind::perspective);
  EXPECT_EQ(later.materials[0].eta, Rgb(0));
  EXPECT_RGB(later.materials[1].reflectance.value, 0.5, 0.5, 0.5, 1e-6);
  EXPECT_FLOAT_EQ(later.materials[1].ior, 1.6f);  // in capitals all the same
  EXPECT_TRUE(says(later.notes, "the image will be black"));
  EXPECT_TRUE(says(later.notes, told));
  EXPECT_FLOAT_EQ(later.shapes[0].to_world[3].x, 3);
}

TEST(Names, ToWorldBesideItsOlderSpellingAndInNewerFiles) {
  const auto placed = [](const std::string& name) {
    return "<shape type='sphere'><transform name='" + name + "'><translate x='3'/></transform></shape>";
  };
  const std::string words = "does not know to_world";
  const Scene both = load_inside(placed("toWorld") + placed("to_world"), {}, "0.6.0");
  EXPECT_TRUE(says(both.notes, "test.xml:2: version 0.6.0 " + words));
  for (const Shape& shape : both.shapes) EXPECT_FLOAT_EQ(shape.to_world[3].x, 3);
  EXPECT_FALSE(says(load_inside(placed("to_world"), {}, "2.0.0").notes, words));
  EXPECT_FALSE(says(load_inside("<default name='to_world' value='1'/>", {}, "0.6.0").notes, words));
}

TEST(Parameters, DefaultIsPutInAndOverruled) {
  const std::string text =
      "<default name='r' value='0.25'/><bsdf type='diffuse' id='m'><rgb name='reflectance' value='$r'/></bsdf>" + ball;
  EXPECT_FLOAT_EQ(grey(load_inside(text)), 0.25f);
  EXPECT_FLOAT_EQ(grey(load_inside(text, define("r", "0.75"))), 0.75f);
}

TEST(Parameters, ADollarAfterABackslashIsOne) {
  const std::string text =
      "<default name='x' value='y'/><texture type='checkerboard' id='a\\$x'/><bsdf type='diffuse'>"
      "<ref name='reflectance' id='a\\$x'/></bsdf>";
  EXPECT_SAYS(error_of(text + "<ref id='none\\$x'/>"), "the id \"none$x\"");
  EXPECT_SAYS(error_of(text + "<ref id='$x\\$'/>"), "the id \"y$\"");
  EXPECT_SAYS(kit::error_of([&] { load_inside(text + "<ref id='none\\$x'/>", {}, "0.6.0"); }), "the id \"none\\y\"");
}

TEST(Parameters, FirstDefaultCounts) {
  EXPECT_FLOAT_EQ(grey(load_inside("<default name='r' value='0.25'/><default name='r' value='0.5'/>"
                                   "<bsdf type='diffuse' id='m'><rgb name='reflectance' value='$r'/></bsdf>" +
                                   ball)),
                  0.25f);
}

TEST(Parameters, StandInAnyAttributeAndInsideText) {
  const Scene s = load_inside(
      "<default name='kind' value='diffuse'/><default name='n' value='m'/><default name='part' value='.2'/>"
      "<default name='partial' value='.4'/><integrator type='$kind'/>"
      "<bsdf type='$kind' id='$n'><rgb name='reflectance' value='$part, $partial, 0$part'/></bsdf>" +
      ball);
  EXPECT_RGB(s.materials[0].reflectance.value, 0.2, 0.4, 0.2, 1e-6);
  EXPECT_TRUE(says(s.notes, "<integrator type=\"diffuse\">: Ajar has no integrator of this name"));
}

TEST(Parameters, DefaultMayNameAnother) {
  EXPECT_FLOAT_EQ(grey(load_inside("<default name='a' value='0.125'/><default name='b' value='$a'/>"
                                   "<bsdf type='diffuse' id='m'><rgb name='reflectance' value='$b'/></bsdf>" +
                                   ball)),
                  0.125f);
}

TEST(Parameters, DefaultBelowItsUseIsFound) {
  EXPECT_FLOAT_EQ(grey(load_inside("<bsdf type='diffuse' id='m'><rgb name='reflectance' value='$grey'/></bsdf>" + ball +
                                   "<include filename='fragment.xml'/>")),
                  0.3f);
}

TEST(Parameters, UnknownOnesAreErrors) {
  std::string e = error_of("<default name='known' value='1'/>\n<integrator type='$nobody'/>");
  EXPECT_SAYS(e, "test.xml:3: <integrator>: the parameter $nobody has no value");
  EXPECT_SAYS(e, "known are known");
  EXPECT_SAYS(error_of("<integrator type='$nobody'/>"), "value=\"...\"/>; no parameter is known");
  e = error_of("<default name='known' value='1'/>", define("unknown", "2"));
  EXPECT_SAYS(e, "-D unknown");
  EXPECT_SAYS(e, "known are known");
  EXPECT_EQ(error_of("<default name='known' value='1'/>", define("known", "2")), "");
}

TEST(Parameters, ADollarAloneNamesNone) {
  EXPECT_EQ(error_of("<bsdf type='$'/>"),
            "test.xml:2: <bsdf>: a $ begins the name of a parameter, and none follows; leave it out");
}

TEST(Parameters, ADollarBesideABracketStaysInOldScenes) {
  const std::string text = "<default name='b' value='c'/><shape type='sphere' id='$a[$b] $'/>";
  EXPECT_EQ(load_inside(text, {}, "0.6.0").shapes[0].name, "$a[c] $");
  EXPECT_SAYS(error_of(text), "the parameter $a has no value");
}

TEST(Parameters, ExplosionIsStopped) {
  std::string text = "<default name='p0' value='xxxxxxxxxxxxxxxx'/>";
  for (char c = 'a'; c < 'z'; ++c) {
    const std::string before = c == 'a' ? "$p0" : std::string("$q") + char(c - 1);
    text += "<default name='q" + std::string(1, c) + "' value='" + before + before + "'/>";
  }
  EXPECT_SAYS(error_of(text), "more than a million characters");
}

TEST(References, PositionalNamedForwardAndAlias) {
  const std::string m = "<bsdf type='diffuse' id='m'><rgb name='reflectance' value='0.5'/></bsdf>";
  EXPECT_FLOAT_EQ(grey(load_inside(m + ball)), 0.5f);
  EXPECT_FLOAT_EQ(grey(load_inside(ball + m)), 0.5f);
  EXPECT_FLOAT_EQ(grey(load_inside(m + "<shape type='sphere'><ref name='bsdf' id='m'/></shape>")), 0.5f);
  EXPECT_FLOAT_EQ(grey(load_inside(m + "<alias id='m' as='n'/><shape type='sphere'><ref id='n'/></shape>")), 0.5f);
}

TEST(References, BsdfNamedTwiceIsReadOnce) {
  const Scene s = load_inside("<bsdf type='diffuse' id='m'/>" + ball + ball);
  EXPECT_EQ(s.materials.size(), 1u);
  EXPECT_EQ(s.shapes[0].material, s.shapes[1].material);
}

TEST(References, WrongOnesAreErrors) {
  EXPECT_SAYS(error_of("\n\n" + ball), "test.xml:4: <ref id=\"m\">: nothing in the scene has the id \"m\"");
  EXPECT_SAYS(error_of("<ref id='n'/>"), "test.xml:2: <ref id=\"n\">: nothing in the scene has the id \"n\"");
  EXPECT_EQ(error_of("<ref id='n'/><alias id='m' as='n'/><bsdf type='diffuse' id='m'/>"), "");
  EXPECT_SAYS(error_of("<shape type='sphere'><ref/></shape>"), "needs id");
  EXPECT_SAYS(error_of("<bsdf type='diffuse' id='m'/>\n<bsdf type='diffuse' id='m'/>"), "taken already at test.xml:2");
  EXPECT_SAYS(error_of("<alias id='a' as='b'/><alias id='b' as='a'/><shape type='sphere'><ref id='a'/></shape>"),
              "circle");
}

// As in Mitsuba: a second name must be free, and be one of something.
TEST(References, AliasesOfNothingAndOfTwoAreErrors) {
  const std::string m = "<bsdf type='diffuse' id='m'/>", n = "<bsdf type='null' id='n'/>";
  EXPECT_SAYS(error_of(m + "\n<alias id='k' as='l'/>"),
              "test.xml:3: <alias id=\"k\">: nothing in the scene has the id \"k\"");
  EXPECT_SAYS(error_of(m + "<alias as='l'/>"), "nothing in the scene has the id \"\"");
  EXPECT_SAYS(error_of(m + n + "\n<alias id='m' as='n'/>"),
              "test.xml:3: <alias id=\"m\">: the id \"n\" is taken already at test.xml:2");
  EXPECT_SAYS(error_of(m + n + "<alias id='m' as='l'/>\n<alias id='n' as='l'/>"),
              "test.xml:3: <alias>: the name \"l\" is taken already by an <alias> at test.xml:2");
  EXPECT_EQ(error_of(m + "<alias id='l' as='k'/><alias id='m' as='l'/><shape type='sphere'><ref id='k'/></shape>"), "");
}

TEST(References, CyclesAreErrors) {
  EXPECT_SAYS(error_of("<bsdf type='twosided' id='a'><ref id='a'/></bsdf>"), "contains itself");
  EXPECT_SAYS(error_of("<bsdf type='mask' id='a'><ref id='b'/></bsdf><bsdf type='mask' id='b'><ref id='a'/></bsdf>"),
              "contains itself");
  EXPECT_SAYS(error_of("<texture type='scale' id='t'><ref id='t'/></texture>"
                       "<bsdf type='diffuse'><ref name='reflectance' id='t'/></bsdf>"),
              "contains itself");
  EXPECT_SAYS(error_of("<shape type='shapegroup' id='g'><shape type='instance'><ref id='g'/></shape></shape>"),
              "an instance inside a shapegroup is not supported");
}

// Elements that name others twice, again and again, are small in the file and endless to evaluate.
TEST(References, ExplosionIsStopped) {
  std::string text = "<bsdf type='null' id='b0'/><texture type='checkerboard' id='t0'/>";
  for (int i = 1; i < 30; ++i) {
    const std::string before = std::to_string(i - 1), here = std::to_string(i);
    text += "<bsdf type='blendbsdf' id='b" + here + "'><ref id='b" + before + "'/><ref id='b" + before + "'/></bsdf>";
  }
  EXPECT_SAYS(error_of(text), "more than 64 bsdfs");
  for (int i = 1; i < 30; ++i) {
    const std::string before = std::to_string(i - 1), here = std::to_string(i);
    text = (i == 1 ? "<texture type='checkerboard' id='t0'/>" : text) + "<texture type='scale' id='t" + here +
           "'><ref id='t" + before + "'/><ref name='scale' id='t" + before + "'/></texture>";
  }
  EXPECT_SAYS(error_of(text + "<bsdf type='diffuse'><ref name='reflectance' id='t29'/></bsdf>"),
              "more than 64 textures");
}

TEST(Include, BringsElementsAndDefaults) {
  const std::string use = "<shape type='sphere'><ref id='included'/></shape>";
  EXPECT_FLOAT_EQ(grey(load_inside("<include filename='fragment.xml'/>" + use)), 0.3f);
  EXPECT_FLOAT_EQ(grey(load_inside("<include filename='fragment.xml'/>" + use, define("grey", "0.7"))), 0.7f);
  EXPECT_FLOAT_EQ(grey(load_inside("<default name='grey' value='0.1'/><include filename='fragment.xml'/>" + use)),
                  0.1f);
  EXPECT_FLOAT_EQ(grey(load_inside("<default name='f' value='fragment'/><include filename='$f.xml'/>" + use)), 0.3f);
  EXPECT_FLOAT_EQ(grey(load_inside("<include filename='lone.xml'/><shape type='sphere'><ref id='lone'/></shape>")),
                  0.6f);
}

TEST(Include, MayBeAParameter) {
  const std::string path = write_file("tex.xml", "<texture version='3.0.0' type='checkerboard'/>");
  const Scene s =
      load_inside("<bsdf type='plastic'><include filename='" + path + "' name='specularReflectance'/></bsdf>");
  EXPECT_NE(s.materials[0].specular.texture, none);
  EXPECT_EQ(s.materials[0].reflectance.texture, none);
}

TEST(Files, NamesOfOtherCapitalsAreTold) {
  EXPECT_SAYS(error_of("<shape type='obj'><string name='filename' value='Folder\\INNER.obj'/></shape>"),
              ", but \"folder/inner.obj\"; correct its capitals");
  EXPECT_SAYS(error_of("<include filename='Fragment.XML'/>"), "but \"fragment.xml\"; correct its capitals");
  EXPECT_SAYS(error_of("<include filename='Fragments.XML'/>"), "correct the name, or add its folder");
}

// Mitsuba 0.6 takes them, and the working folder is the last that all versions look in.
TEST(Files, AreFoundInOtherCapitalsByOldScenesAndInTheWorkingFolder) {
  const std::string inner = "<shape type='obj'><string name='filename' value='Folder\\INNER.obj'/></shape>";
  EXPECT_EQ(load_inside(inner, {}, "0.6.0").shapes.size(), 1u);
  const std::filesystem::path mesh = write_file("ground.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string ground =
      "<shape type='obj'><string name='filename' value='" + mesh.filename().string() + "'/></shape>";
  EXPECT_SAYS(error_of(ground), "there is no file");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(mesh.parent_path());
  const Scene s = load_inside(ground);
  std::filesystem::current_path(before);
  EXPECT_EQ(s.shapes.size(), 1u);
}

// What comes into it later is not noticed.
TEST(Files, FoldersAreListedOnceForOtherCapitals) {
  const std::filesystem::path folder = testing::TempDir() + "ajar-capitals";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "Inner");
  std::ofstream(folder / "Inner" / "A.obj");
  std::ofstream(folder / "Inner" / "B.obj");
  const Document document = read_document("<scene version='0.6.0'/>", folder.string(), "test.xml", {});
  const auto found = [&](const std::string& name) { return find_file(document, document.root, name); };
  EXPECT_EQ(found("inner/a.OBJ"), (folder / "Inner" / "A.obj").string());
  EXPECT_EQ(found("INNER\\b.obj"), (folder / "Inner" / "B.obj").string());
  std::ofstream(folder / "Inner" / "C.obj");
  EXPECT_EQ(found("inner/c.obj"), "");
  EXPECT_EQ(found("Inner/C.obj"), (folder / "Inner" / "C.obj").string());
  std::filesystem::remove_all(folder);
}

TEST(Files, PointersOfGitLfsAreTold) {
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n";
  const std::string path = write_file("pointer", pointer),
                    says_so = "is a pointer of Git LFS, not the file itself; fetch it";
  for (const char* type : {"obj", "ply", "serialized"})
    EXPECT_SAYS(
        error_of(std::string("<shape type='") + type + "'><string name='filename' value='" + path + "'/></shape>"),
        says_so);
  EXPECT_SAYS(error_of("<emitter type='envmap'><string name='filename' value='" + path + "'/></emitter>"), says_so);
  EXPECT_SAYS(error_of("<include filename='" + path + "'/>"), says_so);
  EXPECT_SAYS(kit::error_of([&] { load_scene(path); }), says_so);
}

TEST(Include, WrongOnesAreErrors) {
  EXPECT_SAYS(error_of("\n<include filename='nowhere.xml'/>"),
              "test.xml:3: <include>: there is no file \"nowhere.xml\" in ");
  EXPECT_SAYS(error_of("<include/>"), "needs filename");
  EXPECT_SAYS(error_of("<include filename='cycle.xml'/>"), "cycle.xml includes itself");
  EXPECT_SAYS(error_of("<include filename='broken.xml'/>"), "test.xml:2: <include>: ");
  EXPECT_SAYS(error_of("<include filename='broken.xml'/>"), "broken.xml:3: not well-formed");
  EXPECT_SAYS(error_of("<include filename='empty.obj'/>"), "test.xml:2: <include>: ");
  EXPECT_SAYS(error_of("<include filename='.'/>"), "there is no file");
}

TEST(Path, AddsAFolder) {
  const std::string mesh = "<shape type='obj'><string name='filename' value='inner.obj'/></shape>";
  EXPECT_SAYS(error_of(mesh), "there is no file \"inner.obj\"");
  EXPECT_EQ(load_inside("<path value='folder'/>" + mesh).shapes.size(), 1u);
  EXPECT_TRUE(says(load_inside("<path value='nofolder'/>").notes, "there is no folder nofolder"));
  EXPECT_EQ(load_inside("<path value=''/>").notes.size(), load_inside("").notes.size());  // the scene's own folder
  EXPECT_SAYS(error_of("<path/>"), "needs value");
}

TEST(Xml, NoSceneIsAnError) {
  const auto error = [](const std::string& text) -> std::string {
    try {
      load_scene_text(text, "", "a.xml");
    } catch (const Error& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_SAYS(error(""), "holds no XML element");
  EXPECT_SAYS(error("  \n "), "holds no XML element");
  EXPECT_SAYS(error("hello"), "holds no XML element");
  EXPECT_SAYS(error(std::string("\x89PNG\r\n\x1a\n\0\0\0", 11)), "a.xml");
  EXPECT_SAYS(error("<scene version='3.0.0'>\n<shape"), "a.xml:2: not well-formed XML");
  EXPECT_SAYS(error("<scene><sensor type='perspective'></scene>"), "not well-formed XML");
  EXPECT_SAYS(error("<html/>"), "outermost element should be <scene>");
  EXPECT_SAYS(error("<scene version='3.0.0'/>"), "has no camera and no shape: add <sensor");
  EXPECT_SAYS(error("<scene version='3.0.0'><shape/></scene>"), "<shape>: has no type; supported: obj");
  EXPECT_SAYS(error("<scene version='3.0.0'><emitter/></scene>"), "<emitter>: has no type; supported: ");
  EXPECT_SAYS(error("<scene version='3.0.0'><bsdf/></scene>"), "<bsdf>: has no type");
  std::string deep = "<scene>";
  for (int i = 0; i < 100000; ++i) deep += "<bsdf>";
  EXPECT_NE(error(deep), "");
  for (int i = 0; i < 100000; ++i) deep += "</bsdf>";
  EXPECT_SAYS(error(deep + "</scene>"), "nested more than 64 deep");
}

// What XML does not allow and its reader lets pass.
TEST(Xml, WhatStandsTwiceIsTold) {
  EXPECT_SAYS(error_of("\n<shape type='sphere' type='cube'/>"),
              "test.xml:3: <shape>: has the attribute type more than once");
  EXPECT_SAYS(
      error_of("<shape type='disk'><transform name='to_world'><translate x='1' y='2' x='3'/></transform></shape>"),
      "<translate>: has the attribute x more than once");
  const Scene s =
      load_scene_text("<scene version='3.0.0'><shape type='sphere'/></scene>\n<!-- --><scene/><scene/>", "", "a.xml");
  EXPECT_TRUE(says(s.notes, "a.xml:2: <scene>: stands after the end of <scene>"));
  EXPECT_FALSE(says(load_inside("<shape type='sphere'/><!-- --><shape type='cube'/>").notes, "stands after"));
  const std::string two = write_file("two.xml", "<shape type='sphere'/>\n<shape type='cube'/>");
  const Scene included = load_inside("<include filename='" + two + "'/>");
  EXPECT_EQ(included.shapes.size(), 1u);
  EXPECT_TRUE(says(included.notes, "two.xml:2: <shape>: stands after the end of <shape>"));
}

TEST(Xml, FilesThatAreNoneAreErrors) {
  const auto error = [](const std::string& path) -> std::string {
    try {
      load_scene(path);
    } catch (const Error& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_SAYS(error("nowhere/nothing.xml"), "nowhere/nothing.xml: there is no such file; check the name");
  EXPECT_SAYS(error(assets()), "is a folder; name a file");
  EXPECT_SAYS(error("/dev/null"), "is not a file");
  const std::filesystem::path loop = std::filesystem::path(testing::TempDir()) / "loop.xml";
  std::filesystem::remove(loop);
  std::filesystem::create_symlink(loop, loop);
  EXPECT_SAYS(error(loop.string()), "loop.xml: cannot be read: ");
  std::filesystem::remove(loop);
}

TEST(Xml, FilesThatMayNotBeReadAreTold) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "closed";
  fs::create_directory(folder);
  std::ofstream(folder / "a.obj") << "v 0 0 0";
  fs::permissions(folder, fs::perms::none);
  const bool open = bool(std::ifstream(folder / "a.obj"));
  const std::string e =
      error_of("<shape type='obj'><string name='filename' value='" + (folder / "a.obj").string() + "'/></shape>");
  fs::permissions(folder, fs::perms::owner_all);
  fs::remove_all(folder);
  if (open) GTEST_SKIP() << "this user may read everything";
  EXPECT_SAYS(e, "a.obj: cannot be read: ");
}

TEST(Xml, LinesAreCountedFromOne) {
  EXPECT_SAYS(error_of("<bsdf type='diffuse'/>\n\n\n<bsdf type='foo'/>"),
              "test.xml:5: <bsdf type=\"foo\">: unknown bsdf; supported: diffuse, twosided");
}

// UTF-16 has its lines where UTF-8 has them.
TEST(Xml, LinesOfUtf16AreCounted) {
  const std::string text = "<scene version='3.0.0'>\n\n<sensor type='perspective'/>\n<shape type='\x7f'/></scene>";
  for (const bool big : {false, true}) {
    std::string wide = big ? "\xfe\xff" : "\xff\xfe";
    for (const char c : text)
      for (int half = 0; half < 2; ++half) wide += (half == 1) == big ? c : '\0';
    try {
      load_scene_text(wide, "", "test.xml");
      ADD_FAILURE();
    } catch (const Error& e) {
      EXPECT_SAYS(std::string(e.what()), "test.xml:4: <shape type=\"\x7f\">: unknown shape");
    }
  }
  // beyond 16 bits
  std::string wide("\xff\xfe", 2);
  for (const char16_t c : std::u16string(u"<scene><sensor type='perspective'/><shape type='\U0001d11e'/></scene>"))
    wide += {char(c & 255), char(c >> 8)};
  try {
    load_scene_text(wide, "", "test.xml");
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_SAYS(std::string(e.what()), "<shape type=\"\xf0\x9d\x84\x9e\">");
  }
}

// Whatever the file is full of.
TEST(Xml, MessagesAreShort) {
  const std::string name(100000, 'z');
  for (const std::string& text :
       {"<shape type='" + name + "'/>", "<shape type='sphere' id='" + name + "'><ref/></shape>",
        "<shape type='sphere'><float name='radius' value='-" + name + "'/></shape>",
        "<shape type='sphere'><ref id='" + name + "'/></shape>", "<" + name + " a='$b'/>"}) {
    EXPECT_NE(error_of(text), "");
    EXPECT_LT(error_of(text).size(), 600u);
  }
}

TEST(Xml, MessagesAreOneLine) {
  EXPECT_EQ(error_of("<bsdf type='fo&#10;o' id='a&#13;b'/>").find_first_of("\n\r"), std::string::npos);
  EXPECT_EQ(error_of("<integrator type='$a&#10;b'/>").find_first_of("\n\r"), std::string::npos);
}

TEST(Xml, UnknownElementsAreErrorsOrNotes) {
  EXPECT_SAYS(error_of("<gadget/>"), "<gadget>: unknown element; supported: integrator, sensor");
  EXPECT_SAYS(error_of("<camera type='perspective'/>"), "unknown element, <sensor> today");
  EXPECT_SAYS(error_of("<bsdf type='mixture'/>"), "unknown bsdf, mixturebsdf today");
  EXPECT_TRUE(says(load_inside("<gadget/>", lenient()).notes, "<gadget>"));
  EXPECT_SAYS(error_of("<bsdf type='diffuse'><hide name='reflectance' value='1'/></bsdf>"), "<hide");
  EXPECT_TRUE(
      says(load_inside("<bsdf type='diffuse'><hide name='reflectance' value='1'/></bsdf>", lenient()).notes, "<hide"));
}

// Mitsuba refuses them.
TEST(Xml, SceneWithoutVersionIsTold) {
  const auto notes = [](const std::string& attributes) {
    return load_scene_text("<scene" + attributes + "><shape type='sphere'/></scene>", "", "a.xml").notes;
  };
  EXPECT_TRUE(says(notes(""), "a.xml:1: <scene>: needs version=\"...\": read as a scene of version 3"));
  EXPECT_TRUE(says(notes(" version='new'"), "a.xml:1: <scene>: \"new\" is not a version: read as"));
  EXPECT_FALSE(says(notes(" version='3.0.0'"), "version"));
}

// Which version 0.x has for what is left out.
TEST(Xml, NullIsNothing) { EXPECT_EQ(load_inside("<null id='none'/>", {}, "0.6.0").shapes.size(), 0u); }

}  // namespace
}  // namespace ajar
