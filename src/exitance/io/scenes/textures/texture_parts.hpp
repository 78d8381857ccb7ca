#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/io/scenes/textures/texture_patches.hpp"

namespace exitance {

/// Part of a textured face.
struct FacePart {
    std::vector<std::uint32_t> corners;  ///< Indices of points of the description.
    PartColour colour;
    double area = 0;  ///< m^2
};

/// Textured faces that were cut.
struct CutFaces {
    std::vector<std::vector<FacePart>> parts;  ///< Parts of each face. A face that is cut but has no parts is a hole.
    std::vector<std::uint8_t> is_cut;          ///< Per face.
    /// Area of holes that were closed and of opaque parts that were left out, m^2.
    double misplaced = 0;
};

/// Largest number of parts by default, for a scene with the given number of faces.
std::size_t default_texture_parts(std::size_t faces);

/// Cuts textured faces where their colour varies: along the axes of their texture coordinates, at borders of pixels,
/// the most beneficial cuts of the scene first (see `cut_texture`), until none removes a squared relative error of
/// 10^-6 or `max_parts` are used. Parts of a face have no gaps between them. Emitting faces get at most 128 parts
/// together, because light of emitters is computed for each. Adds points to the description. The result does not depend
/// on the unit of length. Cost: O(faces) for small faces; O(cells) for those that are large enough to be cut.
/// faces    faces whose colour varies
/// whitest  upper limit of reflectances
/// Parts that are mostly holes are left out, so that as much area remains as the pictures cover.
CutFaces cut_textured_faces(SceneDescription& description, std::span<const VaryingFace> faces, double whitest,
                            std::size_t max_parts);

}  // namespace exitance
