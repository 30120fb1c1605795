// Whole scenes: our own, and those of others where they are at hand.
#include <unistd.h>

#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

size_t triangles(const Scene& s) {
  size_t n = 0;
  for (const Mesh& m : s.meshes) n += m.triangles.size();
  return n;
}

TEST(OwnScenes, AllLoadWithoutANote) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_path("scenes"))) {
    const std::filesystem::path file = entry.path() / (entry.path().filename().string() + ".xml");
    if (!std::filesystem::exists(file)) continue;
    ++count;
    SCOPED_TRACE(file.string());
    const Scene s = load_scene(file.string());
    EXPECT_FALSE(s.lights.empty());
    EXPECT_FALSE(s.shapes.empty());
    EXPECT_TRUE(s.notes.empty()) << s.notes.front();
  }
  EXPECT_GT(count, 5);
}

TEST(OwnScenes, TheDoorTurns) {
  LoadOptions open;
  open.defines["door"] = "60";
  const std::string file = source_path("scenes/ajar/ajar.xml");
  const Scene a = load_scene(file), b = load_scene(file, open);
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  int moved = 0;
  for (size_t i = 0; i < a.meshes.size(); ++i) moved += a.meshes[i].positions != b.meshes[i].positions;
  EXPECT_GT(moved, 0);
  EXPECT_LT(moved, 5);
}

// Scene::content tells scenes apart by what their files hold, not by where they lie or whether a cache had them.
TEST(OwnScenes, ContentIsThatOfAllFiles) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / ("ajar content" + std::to_string(::getpid()));
  const auto write = [&](const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; };
  fs::create_directories(folder / "copy");
  const std::pair<std::string, std::string> files[] = {
      {"scene.xml",
       "<scene version='3.0.0'><include filename='lamp.xml'/><sensor type='perspective'/>"
       "<shape type='obj'><string name='filename' value='mesh.obj'/><bsdf type='diffuse'>"
       "<texture name='reflectance' type='bitmap'><string name='filename' value='image.pfm'/></texture>"
       "</bsdf></shape></scene>"},
      {"lamp.xml",
       "<scene version='3.0.0'><emitter type='constant'><spectrum name='radiance' filename='light.spd'/>"
       "</emitter></scene>"},
      {"mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"},
      {"image.pfm", std::string("PF\n1 1\n-1.0\n") + std::string(12, '\0')},
      {"light.spd", "400 1\n700 1\n"}};
  for (const auto& [name, text] : files) write(name, text), write("copy/" + name, text);
  const auto content = [&](const std::string& name, LoadCache* cache = nullptr) {
    LoadOptions options;
    options.cache = cache;
    return load_scene((folder / name).string(), options).content;
  };
  LoadCache cache;
  const uint64_t whole = content("scene.xml");
  EXPECT_NE(whole, 0u);
  EXPECT_EQ(content("copy/scene.xml"), whole);
  EXPECT_EQ(content("scene.xml", &cache), whole);
  EXPECT_EQ(content("scene.xml", &cache), whole);
  for (const auto& [name, text] : files) {
    std::string other = text;
    other.back() = other.back() == '\0' ? '\1' : ' ';  // of the same size
    if (name.ends_with("xml")) other = text + " ";
    write(name, other);
    EXPECT_NE(content("scene.xml"), whole) << name;
    write(name, text);
  }
  EXPECT_EQ(content("scene.xml"), whole);
  fs::remove_all(folder);
}

TEST(SharedScenes, VeachAjarIsTheSameInBothSpellings) {
  const std::string modern = shared_path("scenes/veach-ajar/scene.xml"),
                    old = shared_path("scenes/veach-ajar/scene_v0.5.xml");
  AJAR_NEEDS(modern);
  const Scene a = load_scene(modern), b = load_scene(old);
  EXPECT_EQ(a.shapes.size(), 22u);
  EXPECT_GT(triangles(a), 380000u);
  EXPECT_EQ(triangles(a), triangles(b));
  ASSERT_EQ(a.materials.size(), b.materials.size());
  EXPECT_EQ(a.hints.max_depth, b.hints.max_depth);
  EXPECT_EQ(a.camera.plane, b.camera.plane);
  EXPECT_EQ(a.camera.to_world, b.camera.to_world);
  for (size_t i = 0; i < a.materials.size(); ++i) {
    SCOPED_TRACE(i);
    const Material &m = a.materials[i], &n = b.materials[i];
    EXPECT_EQ(m.kind, n.kind);
    EXPECT_EQ(m.distribution, n.distribution);
    EXPECT_EQ(m.inner, n.inner);
    EXPECT_EQ(m.reflectance.value, n.reflectance.value);
    EXPECT_EQ(m.alpha_u.value, n.alpha_u.value);
    EXPECT_EQ(m.eta, n.eta);
    EXPECT_FLOAT_EQ(m.ior, n.ior);
  }
  ASSERT_EQ(a.textures.size(), b.textures.size());
  for (size_t i = 0; i < a.textures.size(); ++i) EXPECT_EQ(a.textures[i].to_uv, b.textures[i].to_uv);
}

TEST(SharedScenes, OthersLoad) {
  for (const char* name : {"cornell-box", "veach-mis"}) {
    const std::string file = shared_path(std::string("scenes/") + name + "/scene.xml");
    AJAR_NEEDS(file);
    const Scene s = load_scene(file);
    EXPECT_FALSE(s.shapes.empty());
    EXPECT_FALSE(s.lights.empty());
  }
}

}  // namespace
}  // namespace ajar
