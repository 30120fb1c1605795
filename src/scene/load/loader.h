// Enters: a Document.
// Leaves: what the readers of single elements share: the growing Scene, names, messages, typed access to parameters.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "ajar/scene/load.h"
#include "mesh.h"
#include "node.h"

namespace ajar {

using DMat4 = glm::dmat4;
using DVec3 = glm::dvec3;

/// How numbers become RGB. reflectance: spectra under D65 (but for version 0.x), so that a flat one is grey; at most 1.
/// ratio: the same without a limit (indices of refraction, roughness). emission: spectra as light, unbounded.
enum class Colour { reflectance, ratio, emission };

/// Indices of refraction, as Mitsuba has them.
inline constexpr double index_of_air = 1.000277, index_of_bk7 = 1.5046;

struct ObjFile;
struct MtlFile;

struct Loader {
  const Document& document;
  bool lenient = false;
  double time = 0;             ///< at which <animation>s are read
  LoadCache* cache = nullptr;  ///< LoadOptions::cache
  Scene scene;
  std::unordered_map<std::string, const Node*> ids;
  std::unordered_map<const Node*, uint32_t> bsdfs, groups;      ///< read already
  std::map<std::pair<const Node*, Colour>, uint32_t> textures;  ///< the same, by what they stand for
  std::vector<const Node*> open;                                ///< being read: a ref to one of them is a cycle
  std::map<std::string, uint32_t> images;                       ///< by path and decoding
  std::map<std::string, int> mesh_uses;                         ///< shapes that name a file
  std::map<std::string, Mesh> meshes;                           ///< parsed files that more than one shape names
  std::shared_ptr<const ObjFile> obj;                           ///< the last that is more than one mesh
  std::map<std::string, std::shared_ptr<const MtlFile>> mtls;   ///< parsed material libraries, by path
  std::map<std::string, uint64_t> sums;                         ///< of files
  std::set<std::string> said;                                   ///< notes, each once
  std::vector<int> texture_sizes, material_sizes;               ///< elements of each, with all that is nested
  uint32_t grey = none, black = none;                           ///< materials of shapes without a bsdf
};

/// Throws Error "file:line: <element>: text".
[[noreturn]] void fail(const Loader& loader, const Node& node, const std::string& text);
/// Adds a note about the element; the same text is said once of what has this type or name, with the first place.
void note(Loader& loader, const Node& node, const std::string& text);
/// "unknown shape", say, or "has no type" where it has none.
std::string unknown(const Node& node);
/// For what Ajar lacks: an Error, or with --lenient a note that ends in what is done instead.
void unsupported(Loader& loader, const Node& node, const std::string& text, const std::string& instead);

/// Adds a file that is read, which the element names, to Scene::content. Throws Error where it is not the file itself.
void count_file(Loader& loader, const Node& node, const std::string& path);
/// Throws Error where an XML file is not the one that an earlier load with this cache read. with_first: its first file
/// is one, and not a text from memory.
void check_texts(const Document& document, bool with_first, LoadCache& cache);
/// The same of all files that were counted, and of a change while they were read. Nothing where no cache is.
void check_unchanged(const Loader& loader);

/// The element itself, or what a <ref> means.
const Node& follow(const Loader& loader, const Node& node);

/// Marks an element as being read for the life of the mark; a second mark on it is an Error (it contains itself).
struct Open {
  Open(Loader& l, const Node& node);
  ~Open() { loader.open.pop_back(); }
  Open(const Open&) = delete;
  Open& operator=(const Open&) = delete;
  Loader& loader;
};

/// The attribute "value"; an Error where it is missing.
const std::string& value_of(const Loader& loader, const Node& node);

// numbers

/// All of the text as one finite number; nothing if it is not.
std::optional<double> to_number(std::string_view text);
/// Numbers divided by commas or blanks; nothing if one is malformed.
std::optional<std::vector<double>> to_numbers(std::string_view text);
/// What a message about malformed numbers adds where one ends in the f of C and of shaders; else nothing.
std::string about_suffix(std::string_view text);
/// The attribute as a number, within the range of float.
double number_attribute(const Loader& loader, const Node& node, const char* name, double otherwise);
/// x, y, z attributes or value="x, y, z" (or one number for all three).
DVec3 vector_of(const Loader& loader, const Node& node, double otherwise);

// parameters of a plugin

/// The children of an element and which of them were asked for.
struct Params {
  Loader& loader;
  const Node& node;
  std::vector<bool> used;

  Params(Loader& l, const Node& n) : loader(l), node(n), used(n.children.size(), false) {}
};

/// The child of one of these names, or nullptr. Of several the last one, in version 0.x the last texture if there is
/// one, as Mitsuba 0.6 has it.
const Node* find(Params& params, std::initializer_list<const char*> names);
bool has(Params& params, const char* name);
double number(Params& params, const char* name, double otherwise);
double positive(Params& params, const char* name, double otherwise);
int integer(Params& params, const char* name, int otherwise, int low, int high);
/// A whole number of 1 or more (or -1 for no limit) that asks for something Ajar need not do: numbers beyond measure
/// become large ones.
int hint(Params& params, const char* name, int otherwise, bool or_unlimited = false);
bool boolean(Params& params, const char* name, bool otherwise);
std::string text(Params& params, const char* name, const std::string& otherwise);
/// One of a few words, in any case; an Error lists them, or with --lenient a note.
std::string choice(Params& params, const char* name, const std::string& otherwise,
                   std::initializer_list<const char*> words);
/// The file that the string parameter `name` means; an Error where it is missing.
std::string file(Params& params, const char* name);
/// Every child of this tag, refs followed, in the order of the file; asks for unnamed and named ones alike.
std::vector<const Node*> nested(Params& params, std::string_view tag);
/// Says which children nobody asked for, except those of the list: names that are known to change nothing.
void note_unused(Params& params, std::initializer_list<const char*> harmless = {});
/// The same, where elements that no plugin has inside are errors.
void finish(Params& params, std::initializer_list<const char*> harmless = {});

// transforms, spectra, textures: in files of the same names

/// Product of the steps of a <transform>, each applied after those before it.
DMat4 transform_of(const Loader& loader, const Node& node);
/// The transform parameter, identity if there is none; an Error where it is singular or projective.
DMat4 to_world(Params& params, const char* name = "to_world");
/// The same of a light, which has to be invertible.
DMat4 regular_to_world(Params& p);
/// Of what stands at a point, to or from which rays go.
void require_near(const Params& p, const DVec3& at);
/// Rotation (and mirror) of a transform, without its scale and position; lights at infinity have neither.
Mat4 orientation(const DMat4& m);
/// The unit vector across a unit vector z that Mitsuba takes where none is given, another one in 0.x than later: the
/// first axis of its frames, and what is up for a camera.
DVec3 across(const DVec3& z, bool old);

/// What a texture needs of the mesh that it is on.
struct Shown {
  std::set<std::string> attributes;
  std::set<uint32_t> limits;  ///< textures of TextureKind::limit
};
/// Adds what this one needs, and those inside of it.
void list_shown(const Scene& scene, const Slot& slot, Shown& out);
/// What stands for a colour or texture: refs followed, and of a d65 what is nested in it, as in Mitsuba's RGB modes.
const Node& meant_by(Loader& loader, const Node& node);
/// <rgb>, <srgb>, <spectrum>, <blackbody>, <float>: linear RGB, not negative.
Rgb colour_of(Loader& loader, const Node& node, Colour kind);
bool is_texture(const Node& node);
/// Complains about a kind of texture that Ajar lacks.
void check_texture(Loader& loader, const Node& node);
/// A parameter that may be a number, a colour or a texture.
Slot slot(Params& params, std::initializer_list<const char*> names, const Slot& otherwise, Colour kind);
/// The same, which a texture without a name may stand for too.
Slot main_slot(Params& params, std::initializer_list<const char*> names, const Slot& otherwise, Colour kind);
/// A slot of an element at hand.
Slot slot_of(Loader& loader, const Node& node, Colour kind);
/// A slot of which one number is asked: of colours the luminance, in version 0.x the mean of their parts; but for that,
/// checkerboards with their colours exchanged.
Slot as_number(Params& params, const Slot& s);
/// A parameter that may be a number or such a texture.
Slot number_slot(Params& params, const char* name, const Slot& otherwise, Colour kind = Colour::ratio);
/// Both multiplied; a constant if both are.
Slot product(Params& params, const Slot& a, const Slot& b);
/// A parameter that has to be one colour.
Rgb colour(Params& params, const char* name, const Rgb& otherwise, Colour kind);
/// Index into Scene::textures; kind says what the numbers in it stand for.
uint32_t load_texture(Loader& loader, const Node& node, Colour kind);
/// Index into Scene::images; the same file decoded in the same way is read once.
uint32_t load_image_file(Loader& loader, const Node& node, const std::string& path, bool raw, double gamma);
/// The image with its numbers within what the kind allows; a copy where that changes it, as other textures may show it
/// as it is.
uint32_t limited_image(Loader& loader, const Node& node, uint32_t index, Colour kind);

// Nested elements may be named again and again by <ref>; evaluating them follows every name, so their number is
// limited.
inline constexpr int max_tree = 64;
uint32_t add_texture(Loader& loader, const Node& node, Texture&& texture);
uint32_t add_material(Loader& loader, const Node& node, const Material& material);
/// Scales diffuse and specular reflectances down that exceed 1 together where they are largest.
void limit_sum(Params& params, Material& material);

/// RGB of wavelength [nm] and value pairs: linear between them, zero outside.
Rgb rgb_of_list(std::vector<std::pair<double, double>> list, Colour kind);
/// Radiance of a black body [W/(m^2 sr nm)] at a temperature in kelvin, as RGB.
Rgb rgb_of_blackbody(double kelvin);

struct Metal {
  const char* name;
  Rgb eta, k;
};
const Metal* find_metal(const std::string& name);
std::string metal_names();
/// Index of refraction of a named dielectric.
std::optional<double> find_dielectric(const std::string& name);
std::string dielectric_names();

/// Tangent of half the field of view along x that fov, fov_axis or focal_length of a camera or projector say; its width
/// and height are read, its axis is set.
double tan_half_x(Params& params, Camera& camera);

// whole elements

uint32_t load_bsdf(Loader& loader, const Node& node);
void load_shape(Loader& loader, const Node& node, uint32_t group);
uint32_t load_shape_group(Loader& loader, const Node& node);
/// shape: the one that emits, for area lights; none for lights of the scene.
void load_emitter(Loader& loader, const Node& node, uint32_t shape);
/// sky, sun, sunsky: adds one light for the sky, one for the sun.
void load_daylight(Params& params, bool with_sky, bool with_sun);
void load_sensor(Loader& loader, const Node& node);
/// Whether Ajar has a sensor of this type, and what is said where it has none.
bool is_camera(const Node& node);
std::string unknown_sensor(const Node& node);
/// When a sensor's shutter opens.
double shutter_open(Loader& loader, const Node& node);
void load_integrator(Loader& loader, const Node& node);

}  // namespace ajar
