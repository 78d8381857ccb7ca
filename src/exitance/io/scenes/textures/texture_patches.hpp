#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exitance/io/scenes/textures/colour_grid.hpp"

namespace exitance {

/// A textured face whose colour varies.
struct VaryingFace {
    std::uint32_t face = 0;  ///< Index into the faces of the description.
    FaceColours colours;
    PartColour colour;  ///< Colour of the whole face.
    double area = 0;    ///< m^2
};

/// A convex planar part of a face on which texture coordinates are an affine function of the position.
struct TextureTile {
    std::uint32_t owner = 0;             ///< Index of the VaryingFace.
    std::vector<std::uint32_t> corners;  ///< Indices of corners of the face.
    std::vector<Vec2> places;            ///< Texture coordinates of the corners, in the patch's frame.
    double area = 0;                     ///< m^2
};

/// Adjacent tiles of one plane whose texture coordinates are one affine function of the position, and which show the
/// same pictures: a rectangle of two triangles, for example.
struct TexturePatch {
    std::vector<std::uint32_t> tiles;  ///< Ascending. A patch of several tiles has no `corner_factors`.
    std::uint32_t largest = 0;         ///< Index of the largest tile.
};

/// Tiles and patches of textured faces. Faces that are not planar, or whose texture coordinates are not affine, are
/// triangulated. Faces without an area, in space or in the picture, and those that intersect themselves have no tiles.
struct TexturePatches {
    std::vector<TextureTile> tiles;
    std::vector<TexturePatch> patches;
};
TexturePatches find_texture_patches(const SceneDescription& description, std::span<const VaryingFace> faces);

/// Samples the colours of a patch on a grid of at most about `max_cells` x `max_cells` cells, whose borders are borders
/// of pixels.
/// whitest  upper limit of reflectances
ColourGrid sample_patch(const SceneDescription& description, std::span<const VaryingFace> faces,
                        const TexturePatches& all, const TexturePatch& patch, std::size_t max_cells, double whitest);

}  // namespace exitance
