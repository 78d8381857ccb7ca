#include "exitance/io/scenes/stl.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/scene/add_polygon.hpp"

namespace exitance {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it lies in memory");

constexpr std::size_t header_bytes = 84;    ///< Binary file: 80 bytes of text and the number of triangles.
constexpr std::size_t triangle_bytes = 50;  ///< Normal, three corners, and two unused bytes.

class StlReader {
  public:
    explicit StlReader(const std::string& path) : path_(path) {
        out_.description.file = path;
        out_.description.materials.push_back({"default", Spectrum(0.5), Spectrum()});
    }

    ReadScene read() {
        const Result<std::string> text = read_whole_file(path_);
        if (!text)
            error(0, text.error().message);
        else if (is_binary(*text))
            read_binary(*text);
        else if (text->find("facet") != text->npos || text->starts_with("solid"))
            read_ascii(*text);
        else
            error(0, "is neither a binary STL file of the stated length nor a text STL file");
        return std::move(out_);
    }

  private:
    void error(int line, std::string message, std::string hint = "") {
        out_.findings.push_back({Finding::Kind::error, path_, line, std::move(message), std::move(hint)});
    }

    static std::uint32_t count_of(const std::string& bytes) {
        std::uint32_t count;
        std::memcpy(&count, bytes.data() + header_bytes - sizeof count, sizeof count);
        return count;
    }
    /// Detects a binary file by its length, since some binary files also begin with "solid".
    static bool is_binary(const std::string& bytes) {
        return bytes.size() >= header_bytes &&
               bytes.size() == header_bytes + triangle_bytes * std::size_t(count_of(bytes));
    }

    void add_triangle(const std::vector<Point>& corners, int line) {
        SceneDescription& d = out_.description;
        if (d.groups.empty()) d.groups.push_back("default");
        SceneDescription::Face& face = add_polygon(d, corners);
        face.group = static_cast<std::uint32_t>(d.groups.size() - 1);
        face.line = line;
    }

    void read_binary(const std::string& bytes) {
        for (std::uint32_t t = 0; t < count_of(bytes); ++t) {
            float numbers[9];
            std::memcpy(numbers, bytes.data() + header_bytes + triangle_bytes * t + 12, sizeof numbers);
            std::vector<Point> corners(3);
            bool finite = true;
            for (std::size_t k = 0; k < 9; ++k) {
                finite &= std::isfinite(numbers[k]);
                corners[k / 3][k % 3] = numbers[k];
            }
            if (finite)
                add_triangle(corners, 0);
            else
                error(0, fmt::format("triangle {} has a coordinate that is not finite", t + 1));
        }
    }

    bool read_vertex(TextLines& lines, Point& p) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string_view word = lines.word();
            if (number_of_word(word, p[i]) == NumberKind::finite) continue;
            error(lines.number(), fmt::format("coordinate '{}' is not a finite number", shown(word)));
            return false;
        }
        return true;
    }

    void read_ascii(const std::string& text) {
        TextLines lines(text);
        std::vector<Point> corners;
        int begun = 0;
        bool sound = true;
        while (lines.next()) {
            const std::string_view key = lines.word();
            if (key == "solid") {
                out_.description.groups.push_back(lines.rest().empty() ? "default" : std::string(lines.rest()));
            } else if (key == "outer") {
                corners.clear(), begun = lines.number(), sound = true;
            } else if (key == "vertex") {
                corners.emplace_back();
                sound &= read_vertex(lines, corners.back());
            } else if (key == "endloop") {
                if (corners.size() != 3)
                    error(begun, fmt::format("a loop has {} vertices, not three", corners.size()));
                else if (sound)
                    add_triangle(corners, begun);
                corners.clear();
            } else if (key != "facet" && key != "endfacet" && key != "endsolid") {
                return error(lines.number(), fmt::format("'{}' is not a keyword of STL", shown(key)));
            }
        }
        if (!corners.empty()) error(begun, "the file ends within a loop");
    }

    const std::string& path_;
    ReadScene out_;
};

}  // namespace

ReadScene read_stl(const std::string& path) {
    return StlReader(path).read();
}

}  // namespace exitance
