// Enters: sizes, gaps, factors.
// Leaves: the stiff and extreme scenes of the stress suite, finished.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar::stress {

/// Pixels of most of their images, either way.
inline constexpr int image_side = 24;

/// That of cornell(), without its lamp.
Scene dark_room();
Scene plain_room();
Scene grey_furnace(float albedo);
/// The same image at any size: a room scaled and then moved, seen by a camera that went along.
Scene moved_room(float scale, const Vec3& shift);
/// Rooms of 2 x 2 x 2 in a row along x, each joined to the next by a doorway. The light is in the last, the camera in
/// the first. Doorways are nearer and farther in turns, or in line: then the camera looks through all of them, since of
/// a light that has to go round so many corners nothing would be left.
Scene corridor(int rooms, bool in_line);
/// Two rooms and a wall between them with a door, so far open, of which a gap is all that light finds, in a wall no
/// thicker than that. The leaf is 1 m wide; shut, it lies in its frame.
Scene door(double degrees);
/// A second floor so far under the floor: nobody may see it.
Scene false_floor(float gap);
/// A lamp so far above the floor, shining up.
Scene floor_lamp(float gap);
/// A lamp in a box whose walls are so near to it; nothing may come out.
Scene boxed_lamp(float gap);
/// The floor in so many strips along x, as thin as that makes them, with triangles without area among them.
Scene strips(int count);
/// The floor in n x n squares.
Scene fine_floor(uint32_t n);
Scene bright_room(float factor);
/// The room, lit faintly, and a room beside it, in nobody's sight, lit by so much more.
Scene beside(float bright);
/// Two boxes without a front in one image, each lit from its ceiling, neither of which the other's light comes to.
Scene in_one_image(float faint, float bright);
/// A floor of one triangle and nothing else but a lamp.
Scene one_triangle();
/// A ball of light of the radius, or the point that it is from afar.
Scene spark(float radius);
/// The room fills the film's height.
Scene film(int width, int height);
/// A ball or a box of glass before a sky of radiance 1: it cannot be seen.
Scene glass_in_sky(float ior, bool box);
/// A pane of glass before a lamp of radiance 1, seen straight: part of it goes to and fro between its sides, and of all
/// of it 2n / (n^2 + 1) arrives.
Scene glass_pane(float ior);
/// The same of a bar, cut at 45 degrees at both ends: what comes in through one is thrown between the sides by total
/// internal reflection, 2 hops + 1 times, and leaves through the other. hops: 1 or more.
Scene glass_bar(float ior, int hops);
/// Glass balls between mirrors under a sky of radiance 1; nothing scatters diffusely.
Scene deltas_in_sky();
Scene black_room();
/// Along the floor from just above it. bumps: 0 none.
Scene grazing(float height, float bumps);

}  // namespace ajar::stress
