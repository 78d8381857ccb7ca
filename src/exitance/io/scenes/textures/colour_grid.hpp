#pragma once

#include <array>
#include <span>
#include <vector>

#include "exitance/io/scenes/textures/face_colours.hpp"

namespace exitance {

/// Columns [i0, i1) and rows [j0, j1) of a grid.
struct GridBox {
    std::size_t i0 = 0, i1 = 0, j0 = 0, j1 = 0;
};

/// Computes the area of each cell of a grid that polygons cover, row by row, in units of the grid's coordinates. Exact
/// but for rounding; polygons may be concave, clockwise or counter-clockwise, and must not overlap. Adds up the signed
/// areas between edges and the right border. O(cells + polygon edges x crossed cells).
/// columns, rows  borders of the cells, ascending; the polygons must be inside
std::vector<double> covered_areas(std::span<const std::vector<Vec2>> polygons, std::span<const double> columns,
                                  std::span<const double> rows);

/// Colours of textured faces on a grid of texture coordinates. Sums over any box of cells take constant time
/// (summed-area table [Crow84]).
class ColourGrid {
  public:
    struct Cell {
        double area = 0;  ///< Area of the faces in the cell, m^2.
        Spectrum reflectance, exitance;
        double coverage = 1;  ///< Share of the area that is not in holes.
    };
    /// `cells` are in order of rows.
    /// `emits`: if false, exitances are not stored, and mean() returns 0 for them.
    ColourGrid(std::vector<double> columns, std::vector<double> rows, std::span<const Cell> cells, bool emits);

    const std::vector<double>& columns() const { return columns_; }
    const std::vector<double>& rows() const { return rows_; }
    GridBox whole() const { return {0, columns_.size() - 1, 0, rows_.size() - 1}; }
    bool emits() const { return emits_; }

    /// Area and means of a box; colours are those of the area without holes.
    Cell mean(const GridBox& box) const;
    /// Mean, deviation and range over a box, of the means of blocks: the grid has about 32 x 32 of them.
    PartColour colour(const GridBox& box) const;

  private:
    static constexpr std::size_t max_sums = 2 + 2 * bands;
    using Sums = std::array<double, max_sums>;
    Sums sums(const GridBox& box) const;
    const double* at(std::size_t i, std::size_t j) const { return table_.data() + (j * columns_.size() + i) * count_; }

    std::vector<double> columns_, rows_;
    bool emits_;
    std::size_t count_;  ///< Number of sums: area, area without holes, reflectances and, if it emits, exitances.
    std::vector<double> table_;  ///< Sums over all cells to the left and above of a grid point.
};

}  // namespace exitance
