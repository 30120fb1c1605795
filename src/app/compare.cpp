// ajar compare: one JSON line of metrics on standard output, and a picture of the differences on request.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "ajar/core/error.h"
#include "ajar/report/metrics.h"
#include "arguments.h"
#include "commands.h"
#include "say.h"

namespace ajar {
namespace {

struct CompareArguments {
  std::string image, reference, variance, diff;
  std::vector<int> crop;
};

Picture cropped(Picture picture, const std::string& path, const std::vector<int>& window) {
  if (window.empty()) return picture;
  try {
    return crop(picture, window[0], window[1], window[2], window[3]);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

Picture read_comparable(const std::string& path, const std::vector<int>& window) {
  Picture picture = cropped(read_picture(path), path, window);
  require_comparable(picture, path, "render it again, or leave it out with --crop");
  return picture;
}

void check_diff(const CompareArguments& arguments) {
  if (arguments.diff.empty()) return;
  if (!is_png(arguments.diff))
    throw Error(fmt::format("--diff {}: is written as PNG; name a file that ends with .png", arguments.diff));
  for (const std::string& read : {arguments.image, arguments.reference, arguments.variance})
    if (!read.empty() && is_same_file(arguments.diff, read))
      throw Error(fmt::format("--diff {}: is one of the images that are compared; name another file", arguments.diff));
  check_file(arguments.diff);
}

void compare_images(const CompareArguments& arguments) {
  check_diff(arguments);
  Picture image = read_comparable(arguments.image, arguments.crop);
  const Picture reference = read_comparable(arguments.reference, arguments.crop);
  if (image.width != reference.width || image.height != reference.height)
    throw Error(fmt::format(
        "{}: has {}x{} pixels, but {} has {}x{}; compare images of one size, or parts of them with --crop",
        arguments.image, image.width, image.height, arguments.reference, reference.width, reference.height));
  if (!arguments.variance.empty()) {
    const Picture variance = cropped(read_picture(arguments.variance), arguments.variance, arguments.crop);
    try {
      image = with_variance(image, variance);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", arguments.variance, error.what()));
    }
    require_comparable(image, arguments.variance);
  }
  const std::string line = to_json(compare(image, reference));
  if (!arguments.diff.empty()) write_png(arguments.diff, difference_picture(image, reference));
  say(stdout, "{}\n", line);
}

}  // namespace

void add_compare(CLI::App& app) {
  CLI::App* command = app.add_subcommand("compare", "Print the difference of two images as one JSON line");
  const auto arguments = std::make_shared<CompareArguments>();
  command->add_option("image", arguments->image, "Image to judge (EXR, or anything that OpenImageIO reads)")
      ->required();
  command
      ->add_option("reference", arguments->reference,
                   "Image that is taken for right, of the same size (with --crop: that has the window, too)")
      ->required();
  command->add_option(
      "--variance", arguments->variance,
      "Variance of the image's pixel values (channels Variance.R, .G, .B or R, G, B); adds the z-test, as do "
      "such channels in either image");
  command->add_option("--crop", arguments->crop, "Compare only this part: X Y WIDTH HEIGHT")->expected(4);
  command->add_option("--diff", arguments->diff,
                      "Write a PNG of the signed relative difference: red brighter, blue darker");
  command->callback([arguments] { compare_images(*arguments); });
}

}  // namespace ajar
