// usage: guest SCENE.xml IMAGE.exr: renders a few samples per pixel and writes the image.
#include <ajar/core/error.h>
#include <ajar/film/picture.h>
#include <ajar/render/render.h>
#include <ajar/report/metrics.h>
#include <ajar/scene/load.h>
#include <ajar/version.h>

#include <cstdio>

static_assert(AJAR_VERSION_MAJOR == 0 && AJAR_VERSION_MINOR >= 1 && AJAR_VERSION_PATCH >= 0);

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  const ajar::Scene scene = ajar::load_scene(argv[1]);
  const ajar::Accel accel(scene);
  ajar::RenderOptions options;
  options.spp = 4;
  ajar::RenderState state = ajar::start_render(scene, options);
  ajar::render(scene, accel, options, state, [](const ajar::RenderState&) { return true; });
  const ajar::Picture picture = ajar::develop(state.film);
  ajar::write_exr(argv[2], picture, {{"guest:spp", 4.0}});
  const ajar::Metrics same = ajar::compare(ajar::read_picture(argv[2]), picture);
  std::printf("%dx%d, mean %g, mse against itself %g\n", picture.width, picture.height, same.mean, same.mse);
  return same.mean > 0 && same.mse == 0 && state.stats.rejected == 0 ? 0 : 1;
} catch (const ajar::Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 2;
}
