#pragma once

#include <vector>

#include "exitance/io/scenes/textures/colour_grid.hpp"

namespace exitance {

/// Measures by which the benefit of a cut is judged.
struct CutScale {
    double length = 1;       ///< Typical distance between surfaces of the scene, m.
    double area = 1;         ///< Total area of the faces, m^2.
    double reflected = 1;    ///< (Sum of area times mean reflectance)^2 over the total area, m^2.
    double flux = 1;         ///< Emitted flux of the scene, mean over bands, W.
    double min_benefit = 0;  ///< Minimum benefit of a cut.
};

/// A part of a textured patch: a box in its texture coordinates. A tree of parts by cuts along the axes.
struct TexturePart {
    PartColour colour;
    double area = 0;                       ///< m^2
    bool is_cut = false, along_s = false;  ///< Cut at the coordinate `at` of s, else of t.
    double at = 0;
    std::size_t children = 0;  ///< Index of the part below `at`; the next one is above.
};

/// The cuts of a patch, the most beneficial first.
struct TextureCuts {
    std::vector<TexturePart> parts;  ///< Parts of the patch; the first one is the whole patch.
    struct Cut {
        std::size_t part = 0;
        double benefit = 0;  ///< Never larger than that of an earlier cut.
    };
    std::vector<Cut> cuts;  ///< Every cut is listed after the cut that made the part it divides.
};

/// Cuts a patch greedily at borders of the grid's cells. The benefit of a cut is an estimate of the squared relative
/// error of the scene's light that it removes:
///
///     (variance of reflectance between the parts times area) / reflected  min(1, d / length)
///     + (variance of coverage between the parts times area) / area of the scene  min(1, d / length)
///     + (flux that is in the wrong part / flux  min(1, d / length))^2
///
/// for parts of the size d. The factor min(1, d / length) accounts for fine patterns, whose parts differ only for
/// surfaces that are about as near as their size. A first cut of some patterns, such as a checkerboard, has no benefit;
/// its benefit is then that of a division into 2^k x 2^k equal parts, per cut.
/// max_cuts       stops after this many
/// metres_s, metres_t  length of a unit of the texture coordinates on the patch
TextureCuts cut_texture(const ColourGrid& grid, const CutScale& scale, std::size_t max_cuts, double metres_s,
                        double metres_t);

}  // namespace exitance
