#include "exitance/io/scenes/view3d.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>

#include "exitance/base/polygon.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/view3d_controls.hpp"
#include "exitance/scene/add_polygon.hpp"
#include "exitance/scene/findings.hpp"
#include "exitance/scene/joining/outline.hpp"
#include "exitance/scene/joining/uncross.hpp"

namespace exitance {
namespace {

constexpr double min_emittance = 0.001, max_emittance = 0.999;  // View3D's limits
/// Largest distance of a quadrangle's corner from its plane, as a share of its size.
constexpr double max_bend = 3e-5;

using Polygon = std::vector<Point>;

/// A surface of the file, of any kind.
struct Piece {
    char kind = 'S';
    int line = 0;
    /// Polygons of the surface: convex unless it crosses itself, and several if other surfaces were cut out of it.
    std::vector<Polygon> parts;
    bool crosses_itself = false;
    Normal normal;
    /// Numbers of the base surface and of the surface with which this one is merged; 0: none.
    std::size_t base = 0, merged = 0;
    double emittance = 0.9;
    std::string name;
};

class View3dReader {
  public:
    View3dReader(const std::string& path, std::string_view text) : path_(path), text_(text) {
        out_.description.file = path;
    }

    /// The masks of the file, after read().
    const std::vector<View3dMask>& masks() const { return masks_; }

    ReadScene read() {
        for (TextLines lines(text_); lines.next() && !ended_;) read_line(lines);
        if (waiting_) error(pieces_.back().line, "the file ends within this surface");
        cut_out();
        add_faces();
        return std::move(out_);
    }

  private:
    void find(Finding::Kind kind, int line, std::string message, std::string hint = "") {
        out_.findings.push_back({kind, path_, line, std::move(message), std::move(hint)});
    }
    void error(int line, std::string message, std::string hint = "") {
        find(Finding::Kind::error, line, std::move(message), std::move(hint));
    }

    void read_line(TextLines& lines) {
        const std::string line = view3d_items(lines.rest());
        TextLines items(line);
        if (!items.next()) return;
        line_ = lines.number();
        if (waiting_ && !std::isalpha(static_cast<unsigned char>(items.rest().front()))) return read_plane(items);
        const std::string_view first = items.word();
        switch (std::tolower(static_cast<unsigned char>(first.front()))) {
            case 't':
            case 'x':
                return;
            case 'e':
            case '*':
                ended_ = true;
                return;
            case 'c':
                return read_controls(items);
            case 'f':
                return read_form(items);
            case 'v':
                return read_vertex(items);
            case 's':
            case 'o':
            case 'm':
            case 'n':
                return read_surface(static_cast<char>(std::toupper(static_cast<unsigned char>(first.front()))), items);
            default:
                find(Finding::Kind::warning, line_, fmt::format("'{}' begins no line of View3D", shown(first)));
        }
    }

    void read_controls(TextLines& items) {
        while (!items.rest().empty()) {
            const std::string written(items.word()), name = view3d_control_name(written);
            double value = 0;
            if (number_of_word(items.word(), value) != NumberKind::finite)
                return find(Finding::Kind::warning, line_, fmt::format("control '{}' has no value", shown(written)));
            if (!is_view3d_control(name))
                find(Finding::Kind::warning, line_,
                     fmt::format("'{}={}' is ignored: View3D has no control of this name", shown(written), value),
                     "its controls are eps, out, encl, emit, row, col, list, maxU, maxO, minO, maxV and prjD");
            if ((name == "encl" || name == "emit" || name == "row" || name == "col") && value != 0)
                find(Finding::Kind::warning, line_,
                     fmt::format("'{}={}' is ignored: all rows are computed, without adjustment", shown(name), value));
        }
    }

    void read_form(TextLines& items) {
        std::string form(items.word());
        std::transform(form.begin(), form.end(), form.begin(), [](unsigned char c) { return std::tolower(c); });
        if (form == "3" || form == "3a")
            planes_ = form == "3a";
        else
            error(line_, fmt::format("geometry '{}' is not read", shown(form)), "3 and 3a are");
    }

    void read_vertex(TextLines& items) {
        const auto number = parse_integer(items.word());
        if (!number || *number != static_cast<long long>(vertices_.size()) + 1)
            error(line_, fmt::format("the number of vertex {} is out of order", vertices_.size() + 1),
                  "vertices are numbered 1, 2, 3, ...");
        Point p;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string_view word = items.word();
            if (number_of_word(word, p[i]) == NumberKind::finite) continue;
            error(line_, fmt::format("coordinate '{}' is not a finite number", shown(word)));
            p[i] = 0;
        }
        vertices_.push_back(p);
    }

    std::optional<std::size_t> read_reference(TextLines& items, const char* what) {
        const std::string_view word = items.word();
        if (word.empty()) return 0;
        const auto number = parse_integer(word);
        if (number && *number >= 0 && *number <= static_cast<long long>(pieces_.size()))
            return static_cast<std::size_t>(*number);
        error(line_, fmt::format("{} '{}' is not an earlier surface", what, shown(word)));
        return std::nullopt;
    }

    void read_surface(char kind, TextLines& items) {
        const auto number = parse_integer(items.word());
        if (!number || *number != static_cast<long long>(pieces_.size()) + 1)
            error(line_, fmt::format("the number of surface {} is out of order", pieces_.size() + 1),
                  "surfaces of all kinds are numbered 1, 2, 3, ...");
        Piece piece;
        piece.kind = kind, piece.line = line_;
        shape_ = 0;
        if (planes_) {
            const std::string_view shape = items.word();
            shape_ = shape.empty() ? '?' : static_cast<char>(std::toupper(static_cast<unsigned char>(shape.front())));
            if (shape_ != 'R' && shape_ != 'Q' && shape_ != 'T')
                return refuse(std::move(piece), fmt::format("shape '{}' is none of R, Q and T", shown(shape)));
            waiting_ = true, numbers_.clear();
        } else if (!read_corners(items, piece)) {
            return refuse(std::move(piece), "");
        }
        if (kind != 'O') read_facts(items, piece);
        if (kind == 'M') check_mask(piece);
        if (!planes_) check_shape(piece);
        pieces_.push_back(std::move(piece));
    }

    /// A mask hides a part of a surface of the result, and is a row of its own.
    void check_mask(const Piece& piece) {
        if (piece.base == 0 || pieces_[piece.base - 1].kind != 'S')
            error(line_, "the base of a mask surface is not a surface of the result", "name it in the column 'base'");
        if (piece.merged > 0) error(line_, "a mask surface cannot be merged", "set its 'cmb' to 0");
    }

    /// Adds an empty piece for a faulty surface, so that the following surfaces keep their numbers.
    void refuse(Piece piece, const std::string& why) {
        if (!why.empty()) error(line_, why);
        piece.parts.clear();
        pieces_.push_back(std::move(piece));
    }

    bool read_corners(TextLines& items, Piece& piece) {
        Polygon& corners = piece.parts.emplace_back();
        for (int k = 0; k < 4; ++k) {
            const std::string_view word = items.word();
            const auto v = parse_integer(word);
            if (k == 3 && v && *v == 0) break;
            if (!v || *v < 1 || *v > static_cast<long long>(vertices_.size())) {
                error(line_, fmt::format("surface names vertex '{}' of {}", shown(word), vertices_.size()));
                return false;
            }
            corners.push_back(vertices_[static_cast<std::size_t>(*v) - 1]);
        }
        return true;
    }

    void read_facts(TextLines& items, Piece& piece) {
        piece.base = read_reference(items, "base").value_or(0);
        piece.merged = read_reference(items, "cmb").value_or(0);
        if (piece.merged > 0 && pieces_[piece.merged - 1].merged > 0)
            error(line_, fmt::format("is merged into surface {}, which is merged itself", piece.merged),
                  "name the first of them");
        if (piece.merged > 0 && pieces_[piece.merged - 1].kind != 'S')
            error(line_, fmt::format("is merged into surface {}, which is not part of the result", piece.merged));
        const std::string_view word = items.word();
        if (!word.empty() && number_of_word(word, piece.emittance) != NumberKind::finite)
            error(line_, fmt::format("emittance '{}' is not a number", shown(word)));
        piece.emittance = std::clamp(piece.emittance, min_emittance, max_emittance);
        piece.name = std::string(items.word());
    }

    /// Reads the numbers of an `F 3a` surface, which may continue on several lines.
    void read_plane(TextLines& items) {
        Piece& piece = pieces_.back();
        while (!items.rest().empty()) {
            double value = 0;
            const std::string_view word = items.word();
            if (number_of_word(word, value) != NumberKind::finite) {
                waiting_ = false;
                return error(line_, fmt::format("'{}' is not a finite number", shown(word)));
            }
            numbers_.push_back(value);
        }
        const std::size_t wanted = 5 + (shape_ == 'R' ? 2 : shape_ == 'Q' ? 8 : 6);
        if (numbers_.size() < wanted) return;
        waiting_ = false;
        const double azimuth = numbers_[3] * pi / 180, tilt = numbers_[4] * pi / 180;
        const auto at = [&](double u, double v) {
            return Point{numbers_[0] - u * std::cos(azimuth) - v * std::cos(tilt) * std::sin(azimuth),
                         numbers_[1] + u * std::sin(azimuth) - v * std::cos(tilt) * std::cos(azimuth),
                         numbers_[2] + v * std::sin(tilt)};
        };
        Polygon& corners = piece.parts.emplace_back();
        if (shape_ == 'R') {
            const double w = numbers_[5], h = numbers_[6];
            corners = {at(0, h), at(0, 0), at(w, 0), at(w, h)};
        } else {
            for (std::size_t k = 5; k < wanted; k += 2) corners.push_back(at(numbers_[k], numbers_[k + 1]));
        }
        check_shape(piece);
    }

    /// Sets the normal and rejects a concave or non-planar outline. The scene's checks split an outline that crosses
    /// itself.
    void check_shape(Piece& piece) {
        const Polygon& p = piece.parts.front();
        const Vec3 area = area_vector(p);
        double size = 0, off = 0;
        for (const Point& c : p) size = std::max(size, norm(c - p[0]));
        EdgePair where{};
        const Normal n = normal_of_corners(p);
        piece.crosses_itself = norm(n) > 0 && crosses_itself(p, n, 1e-9 * size, where);
        if (!(norm(area) > 1e-14 * size * size)) return;  // the scene's checks remove or split it, and report it
        piece.normal = normalized(area);
        if (piece.crosses_itself) return;
        bool convex = true;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3 in = p[(i + 1) % p.size()] - p[i], out = p[(i + 2) % p.size()] - p[(i + 1) % p.size()];
            convex &= dot(cross(in, out), piece.normal) > -1e-9 * size * size;
            off = std::max(off, std::abs(dot(piece.normal, p[i] - p[0])));
        }
        if (!convex) error(piece.line, "quadrangle is not convex", "split it, and merge the pieces by 'cmb'");
        if (off > max_bend * size) error(piece.line, fmt::format("quadrangle is {:.3g} m out of plane", off));
    }

    /// Cuts subsurfaces, masks and null surfaces out of their bases: for each edge, the part of the base outside it is
    /// kept and the rest goes to the next edge.
    void cut_out() {
        for (const Piece& piece : pieces_) {
            if (piece.base == 0 || piece.parts.empty()) continue;
            Piece& base = pieces_[piece.base - 1];
            if (piece.kind == 'M' && dot(piece.normal, base.normal) > 0)
                error(piece.line, "a mask surface faces like its base", "order its corners the other way round");
            if (piece.crosses_itself || base.crosses_itself) {
                error(piece.line, "a quadrangle that crosses itself cannot be cut out, nor have parts cut out",
                      "order its corners counter-clockwise");
                continue;
            }
            const Polygon& hole = piece.parts.front();
            std::vector<Polygon> left;
            for (const Polygon& part : base.parts) {
                Polygon rest = part, outer, inner;
                for (std::size_t i = 0; i < hole.size() && rest.size() >= 3; ++i) {
                    const Point &a = hole[i], &b = hole[(i + 1) % hole.size()];
                    Vec3 inward = cross(piece.normal, b - a);
                    if (!(norm(inward) > 0)) continue;
                    inward = inward / norm(inward);
                    const double offset = dot(inward, a);
                    clip(rest, {-inward, -offset}, outer);
                    clip(rest, {inward, offset}, inner);
                    if (has_area(outer)) left.push_back(outer);
                    rest = inner;
                }
            }
            base.parts = std::move(left);
        }
    }

    static bool has_area(const Polygon& p) {
        if (p.size() < 3) return false;
        double size = 0;
        for (const Point& c : p) size = std::max(size, norm(c - p[0]));
        return norm(area_vector(p)) > 1e-9 * size * size;
    }

    std::uint32_t material(double emittance) {
        const auto [known, is_new] =
            materials_.try_emplace(emittance, static_cast<std::uint32_t>(out_.description.materials.size()));
        if (is_new)
            out_.description.materials.push_back(
                {fmt::format("emittance_{:g}", emittance), Spectrum(1 - emittance), Spectrum()});
        return known->second;
    }

    void add_faces() {
        SceneDescription& d = out_.description;
        std::vector<std::uint32_t> group(pieces_.size() + 1, 0);
        for (std::size_t k = 1; k <= pieces_.size(); ++k) {
            const Piece& piece = pieces_[k - 1];
            if (piece.kind != 'S' && piece.kind != 'M') continue;
            if (piece.merged > 0) {
                group[k] = group[piece.merged];
                continue;
            }
            group[k] = static_cast<std::uint32_t>(d.groups.size());
            if (piece.kind == 'M') masks_.push_back({group[k], piece.base > 0 ? group[piece.base] : 0});
            d.groups.push_back(piece.name.empty() ? fmt::format("surface {}", k) : piece.name);
        }
        const auto obstructions = static_cast<std::uint32_t>(d.groups.size());
        d.groups.push_back(view3d_obstructions);
        for (std::size_t k = 1; k <= pieces_.size(); ++k) {
            const Piece& piece = pieces_[k - 1];
            if (piece.kind == 'N') continue;
            for (const Polygon& part : piece.parts) {
                SceneDescription::Face& face = add_polygon(d, part);
                face.material = material(piece.emittance);
                face.group = piece.kind == 'O' ? obstructions : group[k];
                face.line = piece.line;
            }
        }
    }

    const std::string& path_;
    std::string_view text_;
    ReadScene out_;
    std::vector<Point> vertices_;
    std::vector<Piece> pieces_;
    std::vector<View3dMask> masks_;
    std::map<double, std::uint32_t> materials_;
    bool planes_ = false, ended_ = false;
    bool waiting_ = false;         ///< True if the last surface is not complete.
    char shape_ = 0;               ///< Shape of the incomplete surface.
    std::vector<double> numbers_;  ///< Numbers of the incomplete surface so far.
    int line_ = 0;
};

}  // namespace

std::vector<View3dMask> read_view3d_masks(const std::string& path) {
    const Result<std::string> text = read_whole_file(path);
    if (!text) return {};
    View3dReader reader(path, *text);
    reader.read();
    return reader.masks();
}

ReadScene read_view3d(const std::string& path) {
    const Result<std::string> text = read_whole_file(path);
    if (text) return View3dReader(path, *text).read();
    return unreadable_scene(path, text.error().message);
}

}  // namespace exitance
