#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/words.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/photometry/ies_text.hpp"
#include "exitance/io/photometry/photometric_file.hpp"
#include "exitance/io/photometry/table_completion.hpp"

namespace exitance {
namespace {

constexpr double foot = 0.3048;

/// Numbers before the table, in the order of the file.
struct Header {
    double lamps = 0, lumens = 0, multiplier = 0, verticals = 0, horizontals = 0, type = 0, units = 0, width = 0,
           length = 0, height = 0, ballast = 0, third = 0, watts = 0;
    int line = 0;
};

class IesReader {
  public:
    IesReader(std::string_view text, const std::string& name) : text_(text, name) { out_.file = name; }
    Result<Photometry> read();

  private:
    Result<void> read_labels();
    void read_label(std::string_view line);
    Result<void> read_tilt();
    Result<void> read_header();
    Result<void> check_header();
    Result<std::vector<double>> read_angles(std::size_t count, const char* kind);
    Result<void> read_table();
    Result<void> make_type_c(const std::vector<double>& vertical, Planes planes);
    Result<void> make_types_ab(const std::vector<double>& vertical, const Planes& planes);
    Opening opening() const;
    void repair(std::string message, std::string hint = "") {
        tell(out_, Finding::Kind::repair, text_.line_number(), std::move(message), std::move(hint));
    }

    IesText text_;
    Photometry out_;
    std::string tilt_;
    /// In files of 1986 and 1991, the third factor is the ballast-lamp photometric factor and is applied.
    bool has_blpf_ = false;
    Header header_;
};

// ------------------------------------------------------------------------------------------------- text

void IesReader::read_label(std::string_view line) {
    constexpr std::size_t max_keywords = 10000;
    if (out_.keywords.size() >= max_keywords) return;
    const std::string_view words = without_blanks(line);
    const std::size_t close = words.find(']');
    if (!words.starts_with('[') || close == std::string_view::npos) {
        if (!words.empty()) out_.keywords.emplace_back("", shown(words));
        return;
    }
    const std::string_view key = words.substr(1, close - 1), value = without_blanks(words.substr(close + 1));
    if (key == "MORE" && !out_.keywords.empty())
        out_.keywords.back().second += ' ' + shown(value);
    else
        out_.keywords.emplace_back(shown(key), shown(value));
}

/// Reads all lines up to the TILT line.
Result<void> IesReader::read_labels() {
    out_.format = "LM-63-1986";
    has_blpf_ = true;
    bool is_first = true;
    while (const auto line = text_.line()) {
        const std::string_view words = without_blanks(*line);
        if (words.starts_with("TILT=")) {
            tilt_ = std::string(without_blanks(words.substr(5)));
            return {};
        }
        if (is_first && (words.starts_with("IES"))) {
            out_.format = shown(words);
            has_blpf_ = words == "IESNA91" || words == "IESNA86";
            if (words != "IESNA91" && words.find("LM-63-") == std::string_view::npos)
                tell(out_, Finding::Kind::warning, 1, fmt::format("the edition '{}' is not known", shown(words)),
                     "it is read as LM-63-2002 is");
        } else {
            read_label(words);
        }
        if (!words.empty()) is_first = false;
    }
    return text_.error("there is no line that begins with TILT=", "every edition of LM-63 has one");
}

/// Reads the tilt factors and ignores them: they describe the loss of a lamp in a tilted luminaire.
Result<void> IesReader::read_tilt() {
    constexpr double max_pairs = 10000;
    if (tilt_ == "NONE") return {};
    if (tilt_ != "INCLUDE") {
        tell(out_, Finding::Kind::warning, text_.line_number() - 1,
             fmt::format("the factors of tilt in '{}' are not read", shown(tilt_)),
             "the light is that of the lamp without tilt");
        return {};
    }
    const Result<double> geometry = text_.number("the geometry of lamp and luminaire");
    if (!geometry) return geometry.error();
    const Result<double> pairs = text_.number("the number of angles of tilt");
    if (!pairs) return pairs.error();
    if (*pairs != std::floor(*pairs) || *pairs < 0 || *pairs > max_pairs)
        return text_.error(fmt::format("{} is not a possible number of angles of tilt", *pairs));
    bool all_one = true;
    for (int i = 0; i < 2 * static_cast<int>(*pairs); ++i) {
        const Result<double> value = text_.number(i < *pairs ? "an angle of tilt" : "a factor of tilt");
        if (!value) return value.error();
        all_one = all_one && (i < *pairs || *value == 1);
    }
    if (!all_one)
        tell(out_, Finding::Kind::warning, text_.line_number(), "the factors of tilt are not applied",
             "the light is that of the lamp without tilt");
    return {};
}

// ------------------------------------------------------------------------------------------------- numbers

Result<void> IesReader::read_header() {
    Header& h = header_;
    const std::array<std::pair<double*, const char*>, 13> fields{{{&h.lamps, "the number of lamps"},
                                                                  {&h.lumens, "the lumens per lamp"},
                                                                  {&h.multiplier, "the multiplier"},
                                                                  {&h.verticals, "the number of vertical angles"},
                                                                  {&h.horizontals, "the number of horizontal angles"},
                                                                  {&h.type, "the type of photometry"},
                                                                  {&h.units, "the kind of units"},
                                                                  {&h.width, "the width"},
                                                                  {&h.length, "the length"},
                                                                  {&h.height, "the height"},
                                                                  {&h.ballast, "the ballast factor"},
                                                                  {&h.third, "the third factor"},
                                                                  {&h.watts, "the input watts"}}};
    for (const auto& [target, what] : fields) {
        const Result<double> value = text_.number(what);
        if (!value) return value.error();
        *target = *value;
        if (h.line == 0) h.line = text_.line_number();
    }
    return check_header();
}

Result<void> IesReader::check_header() {
    Header& h = header_;
    const auto is_count = [](double v) { return v == std::floor(v) && v >= 1 && v <= max_photometric_angles; };
    if (!is_count(h.verticals))
        return text_.error(fmt::format("{:g} is not a possible number of vertical angles", h.verticals));
    if (!is_count(h.horizontals))
        return text_.error(fmt::format("{:g} is not a possible number of horizontal angles", h.horizontals));
    if (h.verticals * h.horizontals > max_photometric_candelas)
        return text_.error(
            fmt::format("{:g} intensities exceed the limit of this program", h.verticals * h.horizontals));
    if (h.verticals < 2) return text_.error("there is only one vertical angle", "a distribution has at least two");
    // Each intensity takes at least a digit and a blank.
    if (2 * h.verticals * h.horizontals > static_cast<double>(text_.bytes_left()) + 2)
        return text_.error(fmt::format("ends before {:g} intensities", h.verticals * h.horizontals),
                           "is the file complete?");
    if (h.type != 1 && h.type != 2 && h.type != 3)
        return text_.error(fmt::format("{:g} is not a type of photometry", h.type), "1 is C, 2 is B, 3 is A");
    if (h.units != 1 && h.units != 2)
        return text_.error(fmt::format("{:g} is not a kind of units", h.units), "1 is feet, 2 is metres");
    if (!(h.multiplier > 0 && h.multiplier < max_photometric_value))
        return text_.error(fmt::format("the multiplier is {:g}", h.multiplier),
                           "it must be above 0: intensities are multiplied by it");
    if (!(h.ballast > 0 && h.ballast < 1e6))
        return text_.error(fmt::format("the ballast factor is {:g}", h.ballast),
                           "it must be above 0: intensities are multiplied by it");
    for (const double size : {h.width, h.length, h.height})
        if (!(std::abs(size) <= 1e4))
            return text_.error(fmt::format("the size {} of the opening is invalid", size), "sizes are at most 10000");
    if (has_blpf_ && !(h.third > 0 && h.third < 1e6))
        return text_.error(fmt::format("the ballast-lamp photometric factor is {:g}", h.third),
                           "intensities are multiplied by it");
    if (!has_blpf_ && std::abs(h.third - 1) > 0.2)
        repair(fmt::format("the third factor is {:g}: it is ignored, since it is not a factor in {}", h.third,
                           out_.format));
    if (h.lamps < 1 || h.lamps != std::floor(h.lamps) || h.lamps > 1e6) {
        repair(fmt::format("{:g} lamps are read as 1", h.lamps));
        h.lamps = 1;
    }
    if (h.watts < 0 || h.watts > 1e9) {
        repair(fmt::format("{:g} W are ignored", h.watts));
        h.watts = 0;
    }
    return {};
}

Result<std::vector<double>> IesReader::read_angles(std::size_t count, const char* kind) {
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i) {
        const Result<double> angle = text_.number(fmt::format("{} angle {} of {}", kind, i + 1, count));
        if (!angle) return angle.error();
        if (!(std::abs(*angle) <= 360)) return text_.error(fmt::format("the {} angle {:g} is invalid", kind, *angle));
        if (i > 0 && !(*angle > out.back()))
            return text_.error(fmt::format("the {} angle {:g} follows {:g}", kind, *angle, out.back()),
                               "angles must rise; is the number of angles right?");
        out.push_back(*angle);
    }
    return out;
}

Result<void> IesReader::read_table() {
    const Result<std::vector<double>> vertical = read_angles(static_cast<std::size_t>(header_.verticals), "vertical");
    if (!vertical) return vertical.error();
    const Result<std::vector<double>> horizontal =
        read_angles(static_cast<std::size_t>(header_.horizontals), "horizontal");
    if (!horizontal) return horizontal.error();
    Planes planes{*horizontal, {}};
    const double factor = header_.multiplier * header_.ballast * (has_blpf_ ? header_.third : 1);
    for (std::size_t h = 0; h < horizontal->size(); ++h) {
        std::vector<double>& row = planes.rows.emplace_back();
        for (std::size_t v = 0; v < vertical->size(); ++v) {
            const Result<double> value = text_.number(
                fmt::format("intensity {} of {}", h * vertical->size() + v + 1, horizontal->size() * vertical->size()));
            if (!value) return value.error();
            if (!(*value >= 0 && *value * factor <= max_photometric_value))
                return text_.error(fmt::format("the intensity {:g} cd is invalid", *value),
                                   "intensities must be 0 or more");
            row.push_back(*value * factor);
        }
    }
    if (!text_.at_end())
        tell(out_, Finding::Kind::warning, text_.line_number(), "the text after the intensities is ignored",
             "is the number of angles right?");
    return header_.type == 1 ? make_type_c(*vertical, std::move(planes)) : make_types_ab(*vertical, planes);
}

// ------------------------------------------------------------------------------------------------- types

Result<void> IesReader::make_type_c(const std::vector<double>& vertical, Planes planes) {
    if (vertical.front() < 0 || vertical.back() > 180)
        return text_.error(fmt::format("vertical angles go from {:g} to {:g}", vertical.front(), vertical.back()),
                           "those of type C are between 0 (down) and 180");
    if (!has_known_range(planes.angle))
        return text_.error(
            fmt::format("horizontal angles go from {:g} to {:g}", planes.angle.front(), planes.angle.back()),
            "those of type C go from 0 to 0, 90, 180 or 360, or from 90 to 270");
    const double first = planes.angle.front(), last = planes.angle.back();
    out_.symmetry = planes.angle.size() == 1 ? "about the axis"
                    : first == 90            ? "about the plane of 90 degrees"
                    : last == 90             ? "in each quadrant"
                    : last == 180            ? "about the plane of 0 degrees"
                                             : "none";
    if (planes.angle.size() == 1 && first != 0)
        repair(fmt::format("the only horizontal angle is {:g}: all planes are assumed to be equal", first));
    if (last > 180 && last < 360)
        if (!(first == 90 && last == 270))
            repair(fmt::format("horizontal angles end at {:g}: the values of angle 0 are taken for 360", last));
    if (last == 360 && planes.rows.front() != planes.rows.back())
        tell(out_, Finding::Kind::warning, text_.line_number(), "intensities at 360 degrees are not those at 0");
    set_table(out_, vertical, completed(planes));
    return {};
}

/// Type B rotates about the axis of H, type A about that of V. With that axis as the polar axis, both have the form of
/// type C: the angle about the axis becomes phi, and the other, from -90 to 90, becomes theta from 0 to 180.
Result<void> IesReader::make_types_ab(const std::vector<double>& vertical, const Planes& planes) {
    std::vector<double> v = vertical, h = planes.angle;
    const bool mirrored_v = v.front() == 0, mirrored_h = h.front() == 0 && h.size() > 1;
    std::vector<std::vector<double>> by_h = planes.rows;
    if (h.size() == 1 && h[0] == 0)
        return text_.error("there is only one horizontal angle", "types A and B have no symmetry about the axis");
    if (mirrored_h) mirror(h, by_h);
    std::vector<std::vector<double>> by_v = transposed(by_h);
    if (mirrored_v) mirror(v, by_v);
    for (const auto* angles : {&v, &h})
        if (angles->front() < -90 || angles->back() > 90)
            return text_.error(fmt::format("angles go from {:g} to {:g}", angles->front(), angles->back()),
                               "those of types A and B are between -90 and 90");
    out_.symmetry = mirrored_v && mirrored_h ? "in each quadrant"
                    : mirrored_h             ? "left and right"
                    : mirrored_v             ? "up and down"
                                             : "none";
    const bool is_b = header_.type == 2;
    out_.type = is_b ? Photometry::Type::b : Photometry::Type::a;
    const std::vector<double>& polar = is_b ? h : v;
    const std::vector<double>& around = is_b ? v : h;
    // make one row per angle around the axis
    const std::vector<std::vector<double>> rows = is_b ? by_v : transposed(by_v);
    std::vector<double> theta;
    for (const double a : polar) theta.push_back(std::clamp(90 + a, 0.0, 180.0));
    const Planes circle = around_axis(around, rows);
    for (std::size_t i = 1; i < circle.angle.size(); ++i)
        if (!(circle.angle[i] > circle.angle[i - 1])) return text_.error("angles are too close to one another");
    set_table(out_, theta, circle);
    // The beam is along the luminaire's -z, V towards +x, H towards +y. The polar angle -90 is along the table's -z.
    if (is_b)
        // d = (cos H sin V, sin H, -cos H cos V): the axis is y, phi = V from -z towards x.
        out_.axis_z = {0, 1, 0}, out_.axis_x = {0, 0, -1}, out_.axis_y = {1, 0, 0};
    else
        // d = (sin V, cos V sin H, -cos V cos H): the axis is x, phi = H from -z towards y.
        out_.axis_z = {1, 0, 0}, out_.axis_x = {0, 0, -1}, out_.axis_y = {0, 1, 0};
    return {};
}

// ------------------------------------------------------------------------------------------------- opening

Opening IesReader::opening() const {
    using Shape = Opening::Shape;
    const double unit = header_.units == 1 ? foot : 1;
    const double w = header_.width * unit, l = header_.length * unit, h = header_.height * unit;
    Opening out{Shape::box, {std::abs(l), std::abs(w), std::abs(h)}};
    Vec3& s = out.size;
    const bool round = (w < 0 || l < 0) && !(w > 0) && !(l > 0);
    if (round && !(w < 0 && l < 0)) s.x = s.y = std::max(s.x, s.y);  // old files may give only one diameter
    if (s.x == 0 && s.y == 0 && s.z == 0) return {Shape::point, {}};
    if (round)
        out.shape = h == 0 ? Shape::ellipse : h > 0 ? Shape::cylinder_z : Shape::ellipsoid;
    else if (w < 0 && h < 0 && l > 0)
        out.shape = Shape::cylinder_x;
    else if (l < 0 && h < 0 && w > 0)
        out.shape = Shape::cylinder_y;
    else if (h == 0)
        out.shape = Shape::rectangle;
    return out;
}

Result<Photometry> IesReader::read() {
    for (const Result<void>& step : {read_labels()})
        if (!step) return step.error();
    if (const Result<void> tilt = read_tilt(); !tilt) return tilt.error();
    if (const Result<void> header = read_header(); !header) return header.error();
    if (const Result<void> table = read_table(); !table) return table.error();
    out_.lamps = static_cast<int>(header_.lamps);
    if (header_.lumens > 0)
        out_.lamp_lumens = header_.lumens * header_.lamps;
    else if (header_.lumens != -1)
        repair(fmt::format("{:g} lm per lamp are read as absolute photometry", header_.lumens),
               "lumens per lamp of -1 declare absolute photometry");
    out_.watts = header_.watts;
    out_.opening = opening();
    if (!(out_.largest() > 0)) return text_.error("all intensities are 0");
    return std::move(out_);
}

}  // namespace

Result<Photometry> read_ies(std::string_view text, const std::string& name) {
    if (text.empty()) return Error{ErrorCode::bad_input, "is empty", name, ""};
    return IesReader(text, name).read();
}

}  // namespace exitance
