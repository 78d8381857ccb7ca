#include "exitance/io/scenes/ply.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is converted to little-endian numbers");

constexpr std::size_t max_corners = 10'000;  ///< Limit on the corners of a face; more indicate a damaged file.

enum class Number : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Number> number_type(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, Number>, 16> names{{{"char", Number::int8},
                                                                         {"int8", Number::int8},
                                                                         {"uchar", Number::uint8},
                                                                         {"uint8", Number::uint8},
                                                                         {"short", Number::int16},
                                                                         {"int16", Number::int16},
                                                                         {"ushort", Number::uint16},
                                                                         {"uint16", Number::uint16},
                                                                         {"int", Number::int32},
                                                                         {"int32", Number::int32},
                                                                         {"uint", Number::uint32},
                                                                         {"uint32", Number::uint32},
                                                                         {"float", Number::float32},
                                                                         {"float32", Number::float32},
                                                                         {"double", Number::float64},
                                                                         {"float64", Number::float64}}};
    for (const auto& [known, type] : names)
        if (known == name) return type;
    return std::nullopt;
}

struct Property {
    std::string name;
    Number type = Number::float32;
    std::optional<Number> count = {};  ///< Type of the number of entries of a list.
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties = {};
};

enum class Encoding : std::uint8_t { text, little_endian, big_endian };

struct Header {
    Encoding encoding = Encoding::text;
    std::vector<Element> elements;
    std::size_t size = 0;  ///< Bytes.
    int lines = 0;
};

/// The numbers behind the header, one after the other.
class Numbers {
  public:
    Numbers(std::string_view body, Encoding encoding) : body_(body), encoding_(encoding), lines_(body) {}

    /// The next number; none where the file ends or has no number.
    std::optional<double> next(Number type) { return encoding_ == Encoding::text ? next_word() : next_binary(type); }
    /// Line of the number read last, from 1; 0 in binary files.
    int line() const { return encoding_ == Encoding::text ? lines_.number() : 0; }

  private:
    std::optional<double> next_word() {
        std::string_view word = lines_.word();
        while (word.empty()) {
            if (!lines_.next()) return std::nullopt;
            word = lines_.word();
        }
        double value = 0;
        if (number_of_word(word, value) == NumberKind::not_a_number) return std::nullopt;
        return value;
    }

    template <class T>
    std::optional<double> take() {
        if (body_.size() < sizeof(T)) return std::nullopt;
        std::array<char, sizeof(T)> bytes;
        std::copy_n(body_.begin(), sizeof(T), bytes.begin());
        if (encoding_ == Encoding::big_endian) std::reverse(bytes.begin(), bytes.end());
        body_.remove_prefix(sizeof(T));
        return static_cast<double>(std::bit_cast<T>(bytes));
    }

    std::optional<double> next_binary(Number type) {
        switch (type) {
            case Number::int8:
                return take<std::int8_t>();
            case Number::uint8:
                return take<std::uint8_t>();
            case Number::int16:
                return take<std::int16_t>();
            case Number::uint16:
                return take<std::uint16_t>();
            case Number::int32:
                return take<std::int32_t>();
            case Number::uint32:
                return take<std::uint32_t>();
            case Number::float32:
                return take<float>();
            default:
                return take<double>();
        }
    }

    std::string_view body_;
    Encoding encoding_;
    TextLines lines_;
};

class PlyReader {
  public:
    explicit PlyReader(const std::string& path) : path_(path) {
        out_.description.file = path;
        out_.description.materials.push_back({"default", Spectrum(0.5), Spectrum()});
        out_.description.groups.push_back("default");
    }

    ReadScene read() {
        const Result<std::string> bytes = read_whole_file(path_);
        if (!bytes)
            error(0, bytes.error().message);
        else if (const std::optional<Header> header = read_header(*bytes))
            read_body(*header, std::string_view(*bytes).substr(header->size));
        return std::move(out_);
    }

  private:
    std::nullopt_t error(int line, std::string message, std::string hint = "") {
        out_.findings.push_back({Finding::Kind::error, path_, line, std::move(message), std::move(hint)});
        return std::nullopt;
    }

    // --- header

    std::optional<Header> read_header(const std::string& bytes) {
        Header header;
        bool has_format = false;
        while (true) {
            const std::size_t end = bytes.find('\n', header.size);
            if (end == std::string::npos) return error(header.lines, "the header has no line 'end_header'");
            TextLines line(std::string_view(bytes).substr(header.size, end - header.size));
            header.size = end + 1, ++header.lines;
            line.next();
            const std::string_view key = line.word();
            if (header.lines == 1) {
                if (key != "ply") return error(1, "is not a PLY file: its first line is not 'ply'");
            } else if (key == "format") {
                const std::string name(line.word());
                if (!read_format(name, line.word(), header)) return std::nullopt;
                has_format = true;
            } else if (key == "element") {
                if (!read_element(line, header)) return std::nullopt;
            } else if (key == "property") {
                if (!read_property(line, header)) return std::nullopt;
            } else if (key == "end_header") {
                if (!has_format) return error(header.lines, "the header has no line 'format'");
                return header;
            }  // comments, obj_info
        }
    }

    bool read_format(std::string_view name, std::string_view version, Header& header) {
        if (version != "1.0") return error(header.lines, fmt::format("unknown version '{}'", shown(version))), false;
        if (name == "ascii")
            header.encoding = Encoding::text;
        else if (name == "binary_little_endian")
            header.encoding = Encoding::little_endian;
        else if (name == "binary_big_endian")
            header.encoding = Encoding::big_endian;
        else
            return error(header.lines, fmt::format("unknown format '{}'", shown(name))), false;
        return true;
    }

    bool read_element(TextLines& line, Header& header) {
        Element element{.name = std::string(line.word())};
        const std::optional<long long> count = parse_integer(line.word());
        if (!count || *count < 0)
            return error(header.lines, fmt::format("element '{}' has no count", shown(element.name))), false;
        element.count = static_cast<std::size_t>(*count);
        header.elements.push_back(std::move(element));
        return true;
    }

    bool read_property(TextLines& line, Header& header) {
        std::string_view word = line.word();
        Property property;
        if (word == "list") {
            property.count = number_type(word = line.word());
            if (!property.count) return error(header.lines, fmt::format("unknown type '{}'", shown(word))), false;
            word = line.word();
        }
        const std::optional<Number> type = number_type(word);
        if (!type) return error(header.lines, fmt::format("unknown type '{}'", shown(word))), false;
        if (header.elements.empty()) return error(header.lines, "a property before the first element"), false;
        property.type = *type, property.name = line.word();
        header.elements.back().properties.push_back(std::move(property));
        return true;
    }

    // --- body

    void read_body(const Header& header, std::string_view body) {
        const auto has = [&](std::string_view name) {
            return std::any_of(header.elements.begin(), header.elements.end(),
                               [&](const Element& e) { return e.name == name; });
        };
        for (const std::string_view needed : {"vertex", "face"})
            if (!has(needed) && !(needed == "face" && has("tristrips")))
                return void(error(0, fmt::format("has no element '{}'", needed), "export it as a mesh of polygons"));
        const auto is_vertex = [](const Element& e) { return e.name == "vertex"; };
        if (std::count_if(header.elements.begin(), header.elements.end(), is_vertex) > 1)
            return void(error(0, "has several elements 'vertex'", "export it with one"));
        warn_of_colours(header);
        Numbers numbers(body, header.encoding);
        for (const Element& element : header.elements)
            if (!read_rows(element, numbers, header.lines)) return;
        for (const SceneDescription::Face& face : out_.description.faces)
            for (const std::uint32_t corner : face.corners)
                if (corner >= out_.description.points.size()) {
                    out_.description.faces.clear();
                    return void(error(face.line, fmt::format("a face has corner {}, but there are {} vertices", corner,
                                                             out_.description.points.size())));
                }
    }

    void warn_of_colours(const Header& header) {
        for (const Element& element : header.elements)
            for (const Property& property : element.properties)
                if (property.name == "red" || property.name == "diffuse_red")
                    return out_.findings.push_back(
                        {Finding::Kind::warning, path_, 0,
                         fmt::format("the colours of its element '{}' are ignored: all faces reflect 0.5",
                                     element.name),
                         "convert it to OBJ or glTF with a material for each colour"});
    }

    /// Reads all rows of an element. False where the file ends early or holds no number.
    bool read_rows(const Element& element, Numbers& numbers, int header_lines) {
        if (element.properties.empty()) return true;  // rows of an element without properties take no space in the file
        const bool is_vertex = element.name == "vertex", is_face = element.name == "face",
                   are_strips = element.name == "tristrips";
        for (std::size_t row = 0; row < element.count; ++row) {
            Point place;
            int coordinates = 0;
            std::vector<double> corners;
            for (const Property& property : element.properties) {
                const bool is_corners =
                    (is_face || are_strips) && (property.name == "vertex_indices" || property.name == "vertex_index");
                std::size_t count = 1;
                if (property.count) {
                    const std::optional<double> entries = numbers.next(*property.count);
                    if (!entries || !(*entries >= 0) || (is_face && is_corners && *entries > max_corners))
                        return broken(element, row, numbers, header_lines);
                    count = static_cast<std::size_t>(*entries);
                }
                for (std::size_t k = 0; k < count; ++k) {
                    const std::optional<double> value = numbers.next(property.type);
                    if (!value) return broken(element, row, numbers, header_lines);
                    if (is_corners) corners.push_back(*value);
                    if (is_vertex && !property.count && property.name.size() == 1 && property.name[0] >= 'x' &&
                        property.name[0] <= 'z')
                        place[static_cast<std::size_t>(property.name[0] - 'x')] = *value, ++coordinates;
                }
            }
            const int line = numbers.line() > 0 ? header_lines + numbers.line() : 0;
            if (is_vertex && !add_vertex(place, coordinates, row, line)) return false;
            if (is_face && !add_face(corners, row, line)) return false;
            if (are_strips && !add_strips(corners, row, line)) return false;
        }
        return true;
    }

    bool broken(const Element& element, std::size_t row, const Numbers& numbers, int header_lines) {
        error(numbers.line() > 0 ? header_lines + numbers.line() : 0,
              fmt::format("element '{}' ends within row {} of {}, or has something other than a number there",
                          element.name, row + 1, element.count));
        return false;
    }

    bool add_vertex(const Point& place, int coordinates, std::size_t row, int line) {
        if (coordinates != 3) return error(0, "element 'vertex' needs properties x, y and z"), false;
        if (!std::isfinite(place.x + place.y + place.z))
            return error(line, fmt::format("vertex {} has a coordinate that is not finite", row)), false;
        out_.description.points.push_back(place);
        return true;
    }

    bool add_face(const std::vector<double>& corners, std::size_t row, int line) {
        SceneDescription::Face face;
        for (const double corner : corners) {
            if (!(corner >= 0 && corner < 4294967295.0 && corner == std::floor(corner)))
                return error(line,
                             fmt::format("face {} refers to vertex {}, which is not a vertex number", row, corner)),
                       false;
            face.corners.push_back(static_cast<std::uint32_t>(corner));
        }
        face.line = line;
        out_.description.faces.push_back(std::move(face));
        return true;
    }

    /// Adds the triangles of strips: each corner but the first two makes one with the two before it, whose front is
    /// that of the strip's first triangle. Negative numbers begin a new strip. Triangles that repeat a corner join
    /// strips and are left out.
    bool add_strips(const std::vector<double>& corners, std::size_t row, int line) {
        std::size_t begin = 0;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            if (corners[k] < 0) begin = k + 1;
            if (k < begin + 2) continue;
            const double a = corners[k - 2], b = corners[k - 1], c = corners[k];
            if (a == b || b == c || c == a) continue;
            const bool is_odd = (k - begin) % 2 == 1;
            if (!add_face(is_odd ? std::vector{b, a, c} : std::vector{a, b, c}, row, line)) return false;
        }
        return true;
    }

    const std::string& path_;
    ReadScene out_;
};

}  // namespace

ReadScene read_ply(const std::string& path) {
    return PlyReader(path).read();
}

}  // namespace exitance
