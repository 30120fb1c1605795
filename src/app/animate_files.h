// Enters: what ajar animate was asked for, and a way to its scenes.
// Leaves: nothing; Error where a file that it reads is missing, unfit, or one that it would write.
#pragma once

#include "animate_options.h"
#include "frames.h"

namespace ajar {

/// The files of the frames of the range and of their figures, and the film, are held apart from all that is read: the
/// scene's, and images and meshes of all scenes that were loaded with the cache.
void check_apart(const AnimateArguments&, const FrameRange&, const Scene&, const LoadCache&);
/// Throws Error where a file of the frame, of the figures or of the film could not be written.
void check_files(const AnimateArguments&, int frame);
/// The same of all frames, but tries nothing unless there is a folder of the name, or what else is no file.
void check_no_folders(const AnimateArguments&, const FrameRange&);
/// Throws Error where .json, .csv or .svg of the figures is a file that ajar animate did not write.
void check_figures(const std::string& stem);
/// Throws Error unless every frame of the range has its reference, sound and of the frame's size.
void check_references(const AnimateArguments&, Shooting&);

}  // namespace ajar
