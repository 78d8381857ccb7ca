#pragma once

#include <string>
#include <vector>

#include "exitance/base/vec.hpp"
#include "exitance/io/pictures/text.hpp"

namespace exitance {

/// Lines and texts on a sheet, in millimetres from its upper left corner, y downwards, for files that are printed and
/// measured.
struct Drawing {
    struct Line {
        std::vector<Vec2> points;  ///< At least two points. If `pieces`, every pair of them is a separate segment.
        Rgb colour{0, 0, 0};
        double width = 0.2;  ///< mm
        bool dashed = false, closed = false, pieces = false;
    };
    struct Text {
        Vec2 at;  ///< Centre of the text, or the middle of its left end.
        std::string words;
        double height = 2.5;  ///< Font height, mm.
        Rgb colour{0, 0, 0};
        bool centred = false, on_white = false;
    };
    Vec2 size;              ///< Size of the sheet, mm.
    Vec2 clip_lo, clip_hi;  ///< Lines are clipped to this rectangle.
    std::vector<Line> lines;
    std::vector<Text> texts;
};

/// Formats a drawing as SVG 1.1, with its size in millimetres.
std::string svg_of(const Drawing& drawing);

/// Formats a drawing as PDF 1.4, one page of the drawing's size. Text is in Helvetica, which every reader has.
/// Characters outside ISO 8859-1 become question marks.
std::string pdf_of(const Drawing& drawing);

}  // namespace exitance
