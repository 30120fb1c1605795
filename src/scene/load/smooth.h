// Enters: a mesh whose vertices lack normals.
// Leaves: the normals, computed from the faces; vertices doubled along sharp edges if asked for.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar {

/// cross(p1 - p0, p2 - p0) of a triangle: twice its area, on the outer side. In double, so that it is zero only where
/// the area is.
glm::dvec3 face_cross(const Mesh& mesh, const glm::uvec3& triangle);

/// Replaces each normal that is zero by the mean of the normals of the faces at the vertex, weighted by the angle that
/// the face has there (Thürmer and Wüthrich 1998, "Computing vertex normals from polygonal facets"). Where the faces
/// cancel each other: the normal of one of them; where they have no area: (0, 0, 1). mesh.normals has its full size.
void fill_normals(Mesh& mesh);

/// Makes normals that are smooth across edges between faces whose normals differ by at most max_angle [degrees], and
/// sharp across others. Edges are found by position, so seams of the texture coordinates do not show. At edges of more
/// than two faces, neighbours in the file's order are compared. Zero normals remain for fill_normals.
void split_sharp_edges(Mesh& mesh, float max_angle);

}  // namespace ajar
