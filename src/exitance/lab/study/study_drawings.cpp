#include "exitance/lab/study/study_drawings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/lab/study/study_analysis.hpp"

namespace exitance {
namespace {

constexpr double picture_width = 640, picture_height = 440, picture_margin = 48;  // pixels
constexpr std::array coordinate_columns = {"x1", "y1", "x2", "y2", "x3", "y3"};

/// Maps coordinates of shapes to pixels.
class DrawingFrame {
  public:
    DrawingFrame(const Table& table, const std::vector<std::size_t>& rows, bool equal_axes) {
        for (const std::size_t row : rows) {
            for (std::size_t k = 0; k < coordinate_columns.size(); ++k) {
                const double at = table.number(row, coordinate_columns[k]);
                if (!std::isfinite(at)) continue;
                min_[k % 2] = std::min(min_[k % 2], at), max_[k % 2] = std::max(max_[k % 2], at);
            }
            if (table.text(row, "shape") != "circle") continue;
            const double x = table.number(row, "x1"), y = table.number(row, "y1");
            const double radius = std::abs(table.number(row, "x2") - x);
            min_ = {std::min(min_[0], x - radius), std::min(min_[1], y - radius)};
            max_ = {std::max(max_[0], x + radius), std::max(max_[1], y + radius)};
        }
        const std::array<double, 2> room{picture_width - 2 * picture_margin, picture_height - 2 * picture_margin};
        for (std::size_t k = 0; k < 2; ++k) scale_[k] = max_[k] > min_[k] ? room[k] / (max_[k] - min_[k]) : 1;
        if (equal_axes) scale_[0] = scale_[1] = std::min(scale_[0], scale_[1]);
        if (max_[0] > min_[0]) first_x_ += 0.5 * (room[0] - scale_[0] * (max_[0] - min_[0]));
    }

    double x(double at) const { return first_x_ + scale_[0] * (at - min_[0]); }
    double y(double at) const { return picture_height - picture_margin - scale_[1] * (at - min_[1]); }
    double least(std::size_t axis) const { return min_[axis]; }
    double most(std::size_t axis) const { return max_[axis]; }

  private:
    double first_x_ = picture_margin;  ///< Pixel of the smallest x; it centres the shapes in the picture.
    std::array<double, 2> min_{HUGE_VAL, HUGE_VAL}, max_{-HUGE_VAL, -HUGE_VAL}, scale_{1, 1};
};

std::string svg_of_shape(const Table& table, std::size_t row, const DrawingFrame& frame) {
    constexpr double dot_radius = 2.2;  // pixels
    const auto x = [&](int point) { return frame.x(table.number(row, fmt::format("x{}", point))); };
    const auto y = [&](int point) { return frame.y(table.number(row, fmt::format("y{}", point))); };
    const std::string& shape = table.text(row, "shape");
    const std::string& colour = table.text(row, "colour");
    if (shape == "dot")
        return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", x(1), y(1), dot_radius,
                           colour);
    if (shape == "circle")
        return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"none\" stroke=\"{}\"/>\n", x(1),
                           y(1), std::abs(x(2) - x(1)), colour);
    if (shape == "line")
        return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"0.7\"/>\n", x(1),
                           y(1), x(2), y(2), colour);
    if (shape == "box")
        return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n",
                           std::min(x(1), x(2)), std::min(y(1), y(2)), std::abs(x(2) - x(1)), std::abs(y(2) - y(1)),
                           colour);
    return fmt::format(
        "<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}z\" fill=\"{}\" stroke=\"#222222\" "
        "stroke-width=\"0.4\"/>\n",
        x(1), y(1), x(2), y(2), x(3), y(3), colour);
}

/// Labels of an axis with the ends of its range.
std::string svg_of_axis(const std::string& label, const DrawingFrame& frame, std::size_t axis) {
    if (label.empty()) return "";
    constexpr double below = 18, beside = 6;  // pixels
    const auto text = [](double x, double y, const char* anchor, const std::string& words) {
        return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, words);
    };
    const std::string ends[] = {fmt::format("{:.3g}", frame.least(axis)), fmt::format("{:.3g}", frame.most(axis))};
    if (axis == 0)
        return text(frame.x(frame.least(0)), picture_height - picture_margin + below, "middle", ends[0]) +
               text(frame.x(frame.most(0)), picture_height - picture_margin + below, "middle", ends[1]) +
               text(0.5 * picture_width, picture_height - picture_margin + 2 * below, "middle", label);
    return text(frame.x(frame.least(0)) - beside, frame.y(frame.least(1)), "end", ends[0]) +
           text(frame.x(frame.least(0)) - beside, frame.y(frame.most(1)) + 2 * beside, "end", ends[1]) +
           fmt::format("<text text-anchor=\"middle\" transform=\"translate({:.1f} {:.1f}) rotate(-90)\">{}</text>\n",
                       below, 0.5 * picture_height, label);
}

std::string name_of_file(const std::string& text) {
    std::string out;
    for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' ? c : '_';
    return out;
}

std::vector<std::size_t> rows_of(const StudyDrawing& drawing, const Table& table, const std::string& name) {
    std::vector<std::size_t> rows = chosen_rows(table, drawing.where, false);
    std::erase_if(rows, [&](std::size_t row) { return table.text(row, "drawing") != name; });
    return rows;
}

}  // namespace

void add_shape(Table& table, const std::string& drawing, const char* shape, std::initializer_list<double> xy,
               const std::string& colour) {
    table.add_row();
    table.set("drawing", drawing), table.set("shape", shape);
    std::size_t k = 0;
    for (const double at : xy) table.set(coordinate_columns.at(k++), field(at));
    table.set("colour", colour);
}

std::string share_colour(double share) {
    static constexpr int stops[][3] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    const double at = std::clamp(share, 0.0, 1.0) * (std::size(stops) - 1);
    const auto i = std::min(static_cast<std::size_t>(at), std::size(stops) - 2);
    const auto part = [&](std::size_t k) {
        const double from = stops[i][k], to = stops[i + 1][k];
        return static_cast<int>(std::lround(from + (at - static_cast<double>(i)) * (to - from)));
    };
    return fmt::format("#{:02x}{:02x}{:02x}", part(0), part(1), part(2));
}

std::string svg_of_shapes(const StudyDrawing& drawing, const Table& table, const std::string& name) {
    const std::vector<std::size_t> rows = rows_of(drawing, table, name);
    const DrawingFrame frame(table, rows, drawing.equal_axes);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\" "
        "font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
        picture_width, picture_height);
    for (const std::size_t row : rows) svg += svg_of_shape(table, row, frame);
    svg += svg_of_axis(drawing.x_label, frame, 0) + svg_of_axis(drawing.y_label, frame, 1);
    return svg + fmt::format("<text x=\"{}\" y=\"20\">{}</text>\n</svg>\n", picture_margin, name);
}

Result<std::vector<DrawnShapes>> draw_shapes(const Study& study, const StudyTables& tables, const std::string& folder) {
    std::vector<DrawnShapes> drawn;
    const std::filesystem::path plots = std::filesystem::path(folder) / "plots";
    std::error_code failed;
    if (!study.drawings.empty()) std::filesystem::create_directories(plots, failed);
    for (const StudyDrawing& drawing : study.drawings) {
        const auto table = tables.find(drawing.table);
        if (table == tables.end()) continue;
        std::set<std::string> known;
        for (const std::size_t row : chosen_rows(table->second, drawing.where, false)) {
            const std::string& name = table->second.text(row, "drawing");
            if (!known.insert(name).second) continue;
            const std::string path = (plots / name_of_file(drawing.name + "_" + name + ".svg")).string();
            if (const Result<void> written = write_file(path, svg_of_shapes(drawing, table->second, name)); !written)
                return written.error();
            drawn.push_back({&drawing, name, path});
        }
    }
    return drawn;
}

}  // namespace exitance
