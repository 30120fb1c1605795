// Enters: learned fields, what was recorded for them, and the scene that they belong to.
// Leaves: their files, and the same back: whatever the bytes of the file, fields that are safe to use, or an Error.
#pragma once

#include <string>

#include "ajar/core/bytes.h"
#include "ajar/field/training.h"
#include "ajar/scene/scene.h"

namespace ajar {

struct StoredFields {
  Fields fields;
  std::string scene;    ///< scene_key of the scene that they were learned in
  uint32_t passes = 0;  ///< whose numbers were drawn, whether they taught or not: who goes on begins with this one
};

/// What fields depend on, as words and a hash: shapes, their places, lights. Not the camera, nor the film.
std::string scene_key(const Scene& scene);

/// Written aside and renamed. Throws Error.
void save_fields(const std::string& path, const StoredFields& stored);
/// key: scene_key of the scene that they are for. Throws Error where the file is damaged, of another version, or of
/// another scene; an empty key takes fields of any scene, to look at.
StoredFields load_fields(const std::string& path, const std::string& key);

// Parts of files: what another file, too, may hold.
void write(Writer& w, const Fields& fields);
void read(Reader& r, Fields& fields);
void write(Writer& w, const Training& training);
/// Throws Error unless it fits the fields.
void read(Reader& r, const Fields& fields, Training& training);
/// In the order of their keys: the same bytes for the same sightings.
void write(Writer& w, const Sightings& sightings);
void read(Reader& r, Sightings& sightings);

}  // namespace ajar
