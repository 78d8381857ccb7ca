#pragma once

#include <string>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/io/pictures/bitmap_font.hpp"

namespace exitance {

/// Lines and words on a sheet, in millimetres from its upper left corner, y downwards: what becomes a file for people
/// who print and measure.
struct Drawing {
    struct Line {
        std::vector<Vec2> points;  ///< From two on; a piece each pair where `pieces`.
        Rgb colour{0, 0, 0};
        double width = 0.2;  ///< mm
        bool dashed = false, closed = false, pieces = false;
    };
    struct Text {
        Vec2 at;  ///< Of the middle of its line, or of its left end.
        std::string words;
        double height = 2.5;  ///< mm, of the font.
        Rgb colour{0, 0, 0};
        bool centred = false, on_white = false;
    };
    Vec2 size;              ///< Of the sheet, mm.
    Vec2 clip_lo, clip_hi;  ///< No line is drawn outside.
    std::vector<Line> lines;
    std::vector<Text> texts;
};

/// As SVG 1.1, with its size in millimetres.
std::string svg_of(const Drawing& drawing);

/// As PDF 1.4, one page of that size; words in Helvetica, which every reader has. Other characters than those of
/// ISO 8859-1 become question marks.
std::string pdf_of(const Drawing& drawing);

}  // namespace exitance
