#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/photometry/photometric_file.hpp"
#include "exitance/io/photometry/table_completion.hpp"

namespace exitance {
namespace {

constexpr double max_planes = 3600;

/// Reads a line that is one finite number, whose decimal separator may be a comma. Returns false for other lines.
bool read_number(std::string_view line, double& value) {
    std::string word(line);
    if (std::count(word.begin(), word.end(), ',') == 1) std::replace(word.begin(), word.end(), ',', '.');
    return number_of_word(word, value) == NumberKind::finite;
}

class EulumdatReader {
  public:
    EulumdatReader(std::string_view text, const std::string& name) : name_(name) {
        if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
        while (!text.empty()) {
            const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
            lines_.push_back(text.substr(0, end));
            text.remove_prefix(end);
            if (!text.empty()) text.remove_prefix(text.starts_with("\r\n") ? 2 : 1);
        }
        out_.file = name;
    }
    Result<Photometry> read();

  private:
    Error error(std::string message, std::string hint = "") const {
        return {ErrorCode::bad_input, std::move(message), fmt::format("{}:{}", name_, at_ + 1), std::move(hint)};
    }
    Result<std::string> text(const char* what);
    Result<double> number(const std::string& what);
    Result<void> numbers(std::span<const std::pair<double*, const char*>> fields);
    Result<std::size_t> count(const char* what, double least, double most);
    Result<void> read_counts();
    Result<void> read_sizes();
    Result<void> read_lamps();
    Result<std::vector<double>> read_angles(std::size_t count, const char* kind, double most);
    Result<void> read_table();
    Result<void> take_planes(const std::vector<double>& circle, std::vector<std::vector<double>> rows);
    std::size_t stored_planes() const;
    std::size_t numbers_left() const;
    void set_opening();
    void check_output_ratio();

    const std::string& name_;
    std::vector<std::string_view> lines_;
    std::size_t at_ = 0;
    Photometry out_;
    std::size_t symmetry_ = 0, planes_ = 0, angles_ = 0;
    double plane_step_ = 0, angle_step_ = 0, conversion_ = 1, ratio_ = 0, tilt_ = 0, flux_ = 0;
    double length_ = 0, width_ = 0, height_ = 0, lit_length_ = 0, lit_width_ = 0;
    std::array<double, 4> lit_height_{};
};

std::string_view trimmed_line(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\x1a");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\x1a") - first + 1);
}

Result<std::string> EulumdatReader::text(const char* what) {
    if (at_ >= lines_.size()) return error(fmt::format("ends before {}", what), "is the file complete?");
    return shown(trimmed_line(lines_[at_++]));
}

/// Reads the number of the next line.
Result<double> EulumdatReader::number(const std::string& what) {
    if (at_ >= lines_.size()) return error(fmt::format("ends before {}", what), "is the file complete?");
    const std::string_view line = trimmed_line(lines_[at_]);
    double value = 0;
    if (!read_number(line, value))
        return error(fmt::format("'{}' is not a number (expected: {})", shown(line), what),
                     line.empty() ? "empty lines count: is one too many above?" : "");
    ++at_;
    return value;
}

Result<void> EulumdatReader::numbers(std::span<const std::pair<double*, const char*>> fields) {
    for (const auto& [target, what] : fields) {
        const Result<double> value = number(what);
        if (!value) return value.error();
        *target = *value;
    }
    return {};
}

Result<std::size_t> EulumdatReader::count(const char* what, double least, double most) {
    const Result<double> value = number(what);
    if (!value) return value.error();
    if (!(*value >= least && *value <= most && *value == std::floor(*value))) {
        --at_;
        return error(fmt::format("{:g} is not a possible {}", *value, what),
                     fmt::format("it must be from {:g} to {:g}", least, most));
    }
    return static_cast<std::size_t>(*value);
}

// ------------------------------------------------------------------------------------------------- header

/// Reads lines 1 to 12: names, symmetry and counts.
Result<void> EulumdatReader::read_counts() {
    static constexpr std::array<const char*, 5> symmetries{"none", "about the axis", "about the plane of C0",
                                                           "about the plane of C90", "in each quadrant"};
    const Result<std::string> company = text("the company");
    if (!company) return company.error();
    out_.keywords.emplace_back("company", *company);
    const Result<std::size_t> kind = count("kind of luminaire", 0, 3);
    if (!kind) return kind.error();
    const Result<std::size_t> symmetry = count("kind of symmetry", 0, 4);
    if (!symmetry) return symmetry.error();
    symmetry_ = *symmetry, out_.symmetry = symmetries[symmetry_];
    const Result<std::size_t> planes = count("number of C planes", 1, max_planes);
    if (!planes) return planes.error();
    planes_ = *planes;
    if ((symmetry_ == 2 && planes_ % 2 != 0) || (symmetry_ >= 3 && planes_ % 4 != 0)) {
        --at_;
        return error(fmt::format("{} C planes do not fit the symmetry {}", planes_, symmetry_),
                     symmetry_ == 2 ? "it needs an even number" : "it needs a multiple of 4");
    }
    const std::array<std::pair<double*, const char*>, 1> step{{{&plane_step_, "the step of C planes"}}};
    if (const Result<void> read = numbers(step); !read) return read;
    const Result<std::size_t> angles = count("number of angles gamma", 2, max_photometric_angles);
    if (!angles) return angles.error();
    angles_ = *angles;
    if (static_cast<double>(planes_) * static_cast<double>(angles_) > max_photometric_candelas)
        return error(fmt::format("{} intensities exceed the limit of this program", planes_ * angles_));
    const std::array<std::pair<double*, const char*>, 1> other{{{&angle_step_, "the step of angles gamma"}}};
    if (const Result<void> read = numbers(other); !read) return read;
    for (const char* what : {"report", "luminaire", "luminaire number", "file", "date"}) {
        const Result<std::string> value = text(what);
        if (!value) return value.error();
        out_.keywords.emplace_back(what, *value);
    }
    return {};
}

/// Reads lines 13 to 25: sizes and factors.
Result<void> EulumdatReader::read_sizes() {
    double downward = 0;
    const std::array<std::pair<double*, const char*>, 13> fields{{{&length_, "the luminaire's length"},
                                                                  {&width_, "the luminaire's width"},
                                                                  {&height_, "the luminaire's height"},
                                                                  {&lit_length_, "the luminous length"},
                                                                  {&lit_width_, "the luminous width"},
                                                                  {&lit_height_[0], "the luminous height in C0"},
                                                                  {&lit_height_[1], "the luminous height in C90"},
                                                                  {&lit_height_[2], "the luminous height in C180"},
                                                                  {&lit_height_[3], "the luminous height in C270"},
                                                                  {&downward, "the downward flux fraction"},
                                                                  {&ratio_, "the light output ratio"},
                                                                  {&conversion_, "the conversion factor"},
                                                                  {&tilt_, "the tilt"}}};
    if (const Result<void> read = numbers(fields); !read) return read;
    for (const double size : {length_, width_, height_, lit_length_, lit_width_, lit_height_[0], lit_height_[1],
                              lit_height_[2], lit_height_[3]})
        if (!(size >= 0 && size <= 1e7)) return error(fmt::format("a length of {:g} mm is invalid", size));
    if (conversion_ == 0) {
        tell(out_, Finding::Kind::repair, static_cast<int>(at_) - 1, "the conversion factor 0 is read as 1");
        conversion_ = 1;
    }
    if (!(conversion_ > 0 && conversion_ < 1e9))
        return error(fmt::format("the conversion factor is {:g}", conversion_),
                     "it must be above 0: intensities are multiplied by it");
    if (tilt_ != 0)
        tell(out_, Finding::Kind::warning, static_cast<int>(at_),
             fmt::format("was measured tilted by {:g} degrees", tilt_), "the table is used as given");
    return {};
}

/// Reads the lamp sets, six lines each, and the ten direct ratios that follow.
Result<void> EulumdatReader::read_lamps() {
    const Result<std::size_t> sets = count("number of sets of lamps", 1, 20);
    if (!sets) return sets.error();
    for (std::size_t i = 0; i < *sets; ++i) {
        const Result<double> lamps = number("the number of lamps");
        if (!lamps) return lamps.error();
        const Result<std::string> type = text("the type of lamps");
        if (!type) return type.error();
        const Result<double> flux = number("the flux of the lamps");
        if (!flux) return flux.error();
        const Result<std::string> colour = text("the colour temperature"), rendering = text("the colour rendering");
        if (!colour) return colour.error();
        if (!rendering) return rendering.error();
        const Result<double> watts = number("the watts of the lamps");
        if (!watts) return watts.error();
        if (i > 0) continue;
        if (!(*flux > 0 && *flux < max_photometric_value)) {
            at_ -= 4;
            return error(fmt::format("the lamps' flux is {:g} lm", *flux), "intensities are given for 1000 lm of it");
        }
        flux_ = *flux;
        const double number = std::abs(*lamps);
        out_.lamps = number >= 1 && number < 1e6 ? static_cast<int>(number) : 1;
        if (number < 1) tell(out_, Finding::Kind::repair, static_cast<int>(at_) - 5, "0 lamps are read as 1");
        if (*lamps >= 0) out_.lamp_lumens = flux_;
        out_.watts = *watts > 0 && *watts < 1e9 ? *watts : 0;
        out_.keywords.emplace_back("lamps", *type);
        if (!colour->empty()) out_.keywords.emplace_back("colour", *colour);
        if (!rendering->empty()) out_.keywords.emplace_back("colour rendering", *rendering);
    }
    if (*sets > 1)
        tell(out_, Finding::Kind::warning, static_cast<int>(at_),
             fmt::format("has {} sets of lamps: the first is used", *sets), "they are alternatives");
    for (int i = 0; i < 10; ++i)
        if (const Result<double> ratio = number("a direct ratio"); !ratio) return ratio.error();
    return {};
}

// ------------------------------------------------------------------------------------------------- table

Result<std::vector<double>> EulumdatReader::read_angles(std::size_t wanted, const char* kind, double most) {
    std::vector<double> out;
    for (std::size_t i = 0; i < wanted; ++i) {
        const Result<double> angle = number(fmt::format("{} {} of {}", kind, i + 1, wanted));
        if (!angle) return angle.error();
        const bool rises = i == 0 ? *angle >= 0 : *angle > out.back();
        if (!rises || !(*angle <= most)) {
            --at_;
            return error(fmt::format("{} {} is {:g}", kind, i + 1, *angle),
                         fmt::format("angles must rise from 0 to {:g}; is their number right?", most));
        }
        out.push_back(*angle);
    }
    return out;
}

std::size_t EulumdatReader::stored_planes() const {
    switch (symmetry_) {
        case 1:
            return 1;
        case 2:
        case 3:
            return planes_ / 2 + 1;
        case 4:
            return planes_ / 4 + 1;
        default:
            return planes_;
    }
}

/// Number of lines up to the first that is not a number.
std::size_t EulumdatReader::numbers_left() const {
    std::size_t n = 0;
    for (std::size_t i = at_; i < lines_.size(); ++i, ++n) {
        double value = 0;
        if (!read_number(trimmed_line(lines_[i]), value)) break;
    }
    return n;
}

Result<void> EulumdatReader::read_table() {
    // Check first, so that no memory is allocated for data that the file cannot contain.
    if (lines_.size() - std::min(at_, lines_.size()) < planes_ + angles_)
        return at_ = lines_.size(), error("ends before the intensities", "is the file complete?");
    const Result<std::vector<double>> circle = read_angles(planes_, "C plane", 360);
    if (!circle) return circle.error();
    const Result<std::vector<double>> gamma = read_angles(angles_, "angle gamma", 180);
    if (!gamma) return gamma.error();
    std::size_t stored = stored_planes();
    if (stored < planes_ && numbers_left() == planes_ * angles_) {
        tell(out_, Finding::Kind::repair, static_cast<int>(at_) + 1,
             fmt::format("the file has all {} planes, although its symmetry needs only {}: all are read", planes_,
                         stored));
        stored = planes_, symmetry_ = 0;
    }
    const double factor = flux_ / 1000 * conversion_;
    std::vector<std::vector<double>> rows;
    for (std::size_t p = 0; p < stored; ++p) {
        std::vector<double>& row = rows.emplace_back();
        for (std::size_t g = 0; g < angles_; ++g) {
            const Result<double> value =
                number(fmt::format("intensity {} of {}", p * angles_ + g + 1, stored * angles_));
            if (!value) return value.error();
            if (!(*value >= 0 && *value * factor <= max_photometric_value)) {
                --at_;
                return error(fmt::format("the intensity {:g} is invalid", *value), "intensities must be 0 or more");
            }
            row.push_back(*value * factor);
        }
    }
    if (std::any_of(lines_.begin() + static_cast<std::ptrdiff_t>(at_), lines_.end(),
                    [](std::string_view line) { return !trimmed_line(line).empty(); }))
        tell(out_, Finding::Kind::warning, static_cast<int>(at_) + 1, "the text after the intensities is ignored",
             "are the numbers of planes and angles right?");
    if (const Result<void> taken = take_planes(*circle, std::move(rows)); !taken) return taken;
    Planes planes;
    planes.angle = out_.phi;
    for (std::size_t p = 0; p < out_.phi.size(); ++p)
        planes.rows.emplace_back(out_.candela.begin() + static_cast<std::ptrdiff_t>(p * angles_),
                                 out_.candela.begin() + static_cast<std::ptrdiff_t>((p + 1) * angles_));
    set_table(out_, *gamma, planes);
    return {};
}

/// Completes the stored planes by their symmetry and stores them in phi and candela.
Result<void> EulumdatReader::take_planes(const std::vector<double>& circle, std::vector<std::vector<double>> rows) {
    Planes planes;
    for (std::size_t p = 0; p < rows.size(); ++p) {
        const std::size_t place = symmetry_ == 3 ? (3 * planes_ / 4 + p) % planes_ : p;
        // With symmetry about the plane of C90, the stored planes go from C270 over C0 to C90. Mirrored at the plane
        // C90 - C270, they go from C90 to C270.
        const double c = circle[place];
        planes.angle.push_back(symmetry_ == 3 ? std::fmod(540 - c, 360) : c);
        planes.rows.push_back(std::move(rows[p]));
    }
    if (symmetry_ == 3) {
        std::reverse(planes.angle.begin(), planes.angle.end());
        std::reverse(planes.rows.begin(), planes.rows.end());
    }
    const bool rises = std::is_sorted(planes.angle.begin(), planes.angle.end());
    const double last = planes.angle.back();
    static constexpr std::array<double, 5> end{0, 0, 180, 270, 90};
    const bool fits = symmetry_ == 1 || planes.angle.size() == 1 ||
                      (symmetry_ == 0 ? last >= 180 : std::abs(last - end[symmetry_]) < 1e-6);
    if (!rises || !fits || !(symmetry_ == 1 || has_known_range(planes.angle) || last > 180))
        return error(fmt::format("C planes from {:g} to {:g} do not fit the symmetry {}", planes.angle.front(), last,
                                 symmetry_));
    if (symmetry_ == 1) planes.angle = {0};
    const Planes whole = completed(planes);
    out_.phi = whole.angle;
    for (const std::vector<double>& row : whole.rows) out_.candela.insert(out_.candela.end(), row.begin(), row.end());
    return {};
}

// ------------------------------------------------------------------------------------------------- opening

/// Sets the luminous opening. EULUMDAT measures the length along C90 - C270, at right angles to the luminaire's x axis.
void EulumdatReader::set_opening() {
    using Shape = Opening::Shape;
    constexpr double metre = 1e-3;
    const bool round = lit_width_ == 0;
    const double length = lit_length_ * metre, width = round ? length : lit_width_ * metre;
    if (length_ > 0) out_.housing = Vec3{length_ * metre, (width_ > 0 ? width_ : length_) * metre, height_ * metre};
    const auto& [c0, c90, c180, c270] = lit_height_;
    const double side_x = std::max(c0, c180) * metre, side_y = std::max(c90, c270) * metre;
    const double height = std::max(side_x, side_y);
    if (length == 0 && width == 0 && height == 0) return;
    out_.opening.size = {width, length, height};
    if (!round) out_.opening.dark_x = height - side_x, out_.opening.dark_y = height - side_y;
    if (round ? std::min({c0, c90, c180, c270}) * metre < height : c0 != c180 || c90 != c270)
        tell(out_, Finding::Kind::warning, 18,
             fmt::format("the luminous heights in C0, C90, C180, C270 are {:g}, {:g}, {:g}, {:g} mm", c0, c90, c180,
                         c270),
             "opposite sides (of a round opening, all sides) are assumed to be as high as the highest");
    out_.opening.shape =
        round ? (height > 0 ? Shape::cylinder_z : Shape::ellipse) : (height > 0 ? Shape::box : Shape::rectangle);
}

void EulumdatReader::check_output_ratio() {
    constexpr double accepted = 0.02;
    if (!(ratio_ > 0)) return;
    out_.stated_output_ratio = ratio_ / 100;
    const double found = out_.flux() / flux_;
    if (std::abs(found / (ratio_ / 100) - 1) > accepted)
        tell(out_, Finding::Kind::warning, 23,
             fmt::format("the light output ratio is {:.4g}% by its line, {:.4g}% by the intensities", ratio_,
                         100 * found),
             "the intensities are used");
}

Result<Photometry> EulumdatReader::read() {
    out_.format = "EULUMDAT";
    if (const Result<void> counts = read_counts(); !counts) return counts.error();
    if (const Result<void> sizes = read_sizes(); !sizes) return sizes.error();
    if (const Result<void> lamps = read_lamps(); !lamps) return lamps.error();
    if (const Result<void> table = read_table(); !table) return table.error();
    set_opening();
    if (!(out_.largest() > 0)) return error("all intensities are 0");
    check_output_ratio();
    return std::move(out_);
}

}  // namespace

Result<Photometry> read_eulumdat(std::string_view text, const std::string& name) {
    if (text.empty()) return Error{ErrorCode::bad_input, "is empty", name, ""};
    return EulumdatReader(text, name).read();
}

}  // namespace exitance
