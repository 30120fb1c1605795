// Enters: a scene of a suite.
// Leaves: the image that is taken for right: the suite's, one made before, or one made now.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "ajar/accel/accel.h"
#include "ajar/core/error.h"
#include "ajar/render/render.h"
#include "ajar/report/bench.h"

namespace ajar {

/// 16 hexadecimal digits (FNV-1a, 64 bits): tells whether something is still what it was.
std::string hash_of(std::string_view bytes);

/// The same of all files that a scene was read from.
std::string content_of(const Scene& scene);

/// A scene ready to be traced; it stays where it is, for the accelerator points to it.
struct LoadedScene {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<Accel> accel;  ///< null before build
  double load_seconds = 0, build_seconds = 0;
};
/// Loads with the suite's defines, size and depth (Scene::hints). Throws Error that names suite and scene.
LoadedScene load(const Suite& suite, const BenchScene& scene);
void build(LoadedScene& loaded);

struct Reference {
  Picture image;                   ///< channels R, G, B
  std::optional<double> relmse;    ///< its own estimated noise
  nlohmann::ordered_json made_by;  ///< how it came to be
};

/// A reference that was rendered and is none. Of that scene nothing can be measured; of others it can.
struct ReferenceRefused : Error {
  using Error::Error;
};

/// The reference if it is there; nothing if it is still to be made. Throws Error for one of another size or made for
/// another request.
std::optional<Reference> find_reference(const Suite& suite, const BenchScene& scene, const Scene& loaded,
                                        const BenchOptions& options);
/// Renders the two parts in batches, going on from those that an earlier call left; nothing when the watch stops it.
/// Throws ReferenceRefused where the two disagree (then the batches stay for a longer run), or find no light at all.
std::optional<Reference> make_reference(const Suite& suite, const BenchScene& scene, const LoadedScene& loaded,
                                        const BenchOptions& options);

}  // namespace ajar
