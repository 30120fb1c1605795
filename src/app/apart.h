// Enters: the files that a command writes, and those that it reads.
// Leaves: nothing; Error where one of them would be written over.
#pragma once

#include <string>
#include <vector>

#include "ajar/scene/scene.h"

namespace ajar {

/// A file, and what names it in messages: "--log", "the record".
struct Named {
  std::string option, path;
};

/// What a scene was read from.
std::vector<Named> files_of(const Scene& scene);

/// Throws Error where both are the same file, there or not.
void require_apart(const Named& output, const Named& other);
/// The same of every output, against the others and against what is read.
void require_apart(const std::vector<Named>& outputs, const std::vector<Named>& read);

}  // namespace ajar
