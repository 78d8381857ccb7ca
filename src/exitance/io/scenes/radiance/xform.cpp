#include "exitance/io/scenes/radiance/xform.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {
namespace {

Affine moved(const Vec3& by) {
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by};
}

Affine scaled(double x, double y, double z) {
    return {{x, 0, 0}, {0, y, 0}, {0, 0, z}, {}};
}

/// Right-handed rotation about an axis. Quarter turns are exact, so that axis-parallel walls stay planar.
Affine turned(char axis, double degrees) {
    const double quarters = degrees / 90;
    double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
    if (quarters == std::round(quarters)) c = std::round(c), s = std::round(s);
    if (axis == 'x') return {{1, 0, 0}, {0, c, s}, {0, -s, c}, {}};
    if (axis == 'y') return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}, {}};
    return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}, {}};
}

Affine power(const Affine& a, std::size_t times) {
    Affine out;
    for (std::size_t i = 0; i < times; ++i) out = a * out;
    return out;
}

/// A sequence of transforms, and how often it is repeated.
struct Stretch {
    Affine once;
    std::size_t times = 1;
    bool is_array = false;
};

class XformParser {
  public:
    XformParser(const std::vector<std::string>& words, std::size_t max_copies)
        : words_(words), max_copies_(max_copies) {}
    Result<Xform> parse();

  private:
    static Error bad(std::string message, std::string hint = "") {
        return {ErrorCode::bad_input, std::move(message), "", std::move(hint)};
    }
    std::optional<double> number() {
        double value = 0;
        if (at_ >= words_.size() || number_of_word(words_[at_], value) != NumberKind::finite) return std::nullopt;
        return ++at_, value;
    }
    std::optional<Affine> transform(const std::string& option);
    bool start_stretch(bool is_array);
    void lay_out(std::vector<Affine>& copies) const;

    const std::vector<std::string>& words_;
    std::size_t max_copies_, at_ = 0, count_ = 1;
    std::vector<Stretch> stretches_{1};
};

std::optional<Affine> XformParser::transform(const std::string& option) {
    if (option == "-t") {
        const auto x = number(), y = number(), z = number();
        return x && y && z ? std::optional(moved({*x, *y, *z})) : std::nullopt;
    }
    if (option == "-mx") return scaled(-1, 1, 1);
    if (option == "-my") return scaled(1, -1, 1);
    if (option == "-mz") return scaled(1, 1, -1);
    const auto value = number();
    if (!value) return std::nullopt;
    if (option == "-s") return *value != 0 ? std::optional(scaled(*value, *value, *value)) : std::nullopt;
    return turned(option[2], *value);
}

bool XformParser::start_stretch(bool is_array) {
    const auto times = number();
    if (!times || *times < 1 || *times != std::floor(*times) || *times > static_cast<double>(max_copies_)) return false;
    stretches_.push_back({{}, static_cast<std::size_t>(*times), is_array});
    if (is_array) count_ *= stretches_.back().times;
    return count_ <= max_copies_;
}

void XformParser::lay_out(std::vector<Affine>& copies) const {
    copies = {Affine()};
    for (const Stretch& stretch : stretches_) {
        std::vector<Affine> next;
        Affine step = stretch.is_array ? Affine() : power(stretch.once, stretch.times);
        for (std::size_t k = 0; k < (stretch.is_array ? stretch.times : 1); ++k) {
            for (const Affine& before : copies) next.push_back(step * before);
            step = stretch.once * step;
        }
        copies = std::move(next);
    }
}

Result<Xform> XformParser::parse() {
    Xform out;
    while (at_ < words_.size()) {
        const std::string& word = words_[at_++];
        const std::size_t first = at_ - 1;
        if (word == "-t" || word == "-rx" || word == "-ry" || word == "-rz" || word == "-s" || word == "-mx" ||
            word == "-my" || word == "-mz") {
            const auto step = transform(word);
            if (!step) return bad(fmt::format("xform's {} has missing or invalid numbers", word));
            stretches_.back().once = *step * stretches_.back().once;
        } else if (word == "-i" || word == "-a") {
            if (!start_stretch(word == "-a"))
                return bad(fmt::format("xform's {} needs a count from 1 to {}", word, max_copies_));
        } else if (word == "-n" || word == "-m") {
            if (at_ >= words_.size()) return bad(fmt::format("xform's {} lacks a name", word));
            (word == "-n" ? out.name : out.material) = words_[at_++];
        } else if (word != "-c" && word != "-e" && word.starts_with("-")) {
            return bad(fmt::format("xform's option '{}' is not known", shown(word)),
                       "known: -t -rx -ry -rz -s -mx -my -mz -i -a -n -m; run xform yourself and read what it writes");
        } else if (!word.starts_with("-")) {
            out.files.push_back(word);
            continue;
        }
        out.options.insert(out.options.end(), words_.begin() + static_cast<std::ptrdiff_t>(first),
                           words_.begin() + static_cast<std::ptrdiff_t>(at_));
    }
    lay_out(out.copies);
    return out;
}

}  // namespace

Result<Xform> parse_xform(const std::vector<std::string>& words, std::size_t max_copies) {
    return XformParser(words, max_copies).parse();
}

Result<Affine> parse_transform(const std::vector<std::string>& words) {
    const Result<Xform> parsed = XformParser(words, 1).parse();
    if (!parsed) return parsed.error();
    if (!parsed->files.empty())
        return Error{ErrorCode::bad_input, fmt::format("'{}' is not a transform", shown(parsed->files[0])), "", ""};
    return parsed->copies[0];
}

}  // namespace exitance
