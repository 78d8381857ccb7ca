#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/pictures/read_directional.hpp"

namespace exitance {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

Error broken(std::string message, const std::string& path, std::string hint = "write the picture again") {
    return {ErrorCode::bad_input, std::move(message), path, std::move(hint)};
}

/// The header of a file, and where its pixels begin.
struct HdrHeader {
    std::array<double, 3> exposure{1, 1, 1};  ///< Divides the values of each colour.
    long long width = 0, height = 0;
    bool bottom_up = false, right_to_left = false;
    std::size_t pixels_at = 0;
};

/// Parses "-Y height +X width"; the signs give the directions of rows and columns.
bool read_resolution(std::string_view line, HdrHeader& out) {
    if (line.size() < 8 || line[1] != 'Y' || (line[0] != '-' && line[0] != '+')) return false;
    const std::size_t x = line.find('X');
    if (x == line.npos || x < 4 || (line[x - 1] != '-' && line[x - 1] != '+')) return false;
    const std::optional<double> height = parse_number(line.substr(2, x - 3)), width = parse_number(line.substr(x + 1));
    constexpr double largest = 1e9;
    const auto is_count = [](double v) { return v >= 1 && v <= largest && v == std::floor(v); };
    if (!height || !width || !is_count(*height) || !is_count(*width)) return false;
    out.height = static_cast<long long>(*height), out.width = static_cast<long long>(*width);
    out.bottom_up = line[0] == '+', out.right_to_left = line[x - 1] == '-';
    return true;
}

/// Applies a line of the header such as "EXPOSURE=2.5" or "COLORCORR=1 1 0.9".
Result<void> read_header_line(std::string_view line, const std::string& path, HdrHeader& out) {
    const std::size_t equals = line.find('=');
    if (equals == line.npos) return {};
    const std::string_view name = line.substr(0, equals);
    std::string_view rest = line.substr(equals + 1);
    if (name == "FORMAT" && !rest.starts_with("32-bit_rle_rgbe"))
        return broken(fmt::format("the pixels have the format '{}'", rest.substr(0, 40)), path,
                      "only 32-bit_rle_rgbe is read; convert it with Radiance's `ra_xyze -r`");
    if (name != "EXPOSURE" && name != "COLORCORR") return {};
    std::array<double, 3> factor{};
    for (std::size_t i = 0; i < 3; ++i) {
        if (name == "EXPOSURE" && i > 0) {
            factor[i] = factor[0];
            continue;
        }
        while (rest.starts_with(' ')) rest.remove_prefix(1);
        const std::optional<double> value = parse_number(rest.substr(0, rest.find(' ')));
        if (!value || !(*value > 0) || !std::isfinite(1 / *value))
            return broken(fmt::format("the header's {} is not a positive number", name), path);
        factor[i] = *value;
        rest.remove_prefix(std::min(rest.size(), rest.find(' ')));
    }
    for (std::size_t i = 0; i < 3; ++i) out.exposure[i] *= factor[i];
    return {};
}

Result<HdrHeader> read_header(std::string_view file, const std::string& path) {
    if (!file.starts_with("#?"))
        return broken("is not a picture of Radiance: it does not begin with #?RADIANCE", path, "use .hdr or .exr");
    HdrHeader out;
    bool is_over = false;
    for (std::size_t begin = 0; begin < file.size();) {
        const std::size_t end = std::min(file.find('\n', begin), file.size());
        std::string_view line = file.substr(begin, end - begin);
        if (line.ends_with('\r')) line.remove_suffix(1);
        begin = end + 1;
        if (is_over) {
            if (!read_resolution(line, out))
                return broken(
                    fmt::format("the line '{}' is not a size of rows, such as -Y 1024 +X 2048", line.substr(0, 40)),
                    path);
            out.pixels_at = begin;
            return out;
        }
        is_over = line.empty();
        if (const Result<void> read = read_header_line(line, path, out); !read) return read.error();
    }
    return broken("ends within the header", path);
}

/// Reads the pixels of a file row by row. Both forms of run-length encoding are understood.
class HdrRows {
  public:
    explicit HdrRows(std::string_view bytes) : bytes_(bytes) {}

    /// Returns false if the file ends early or a run is longer than the row.
    bool next(std::vector<Rgbe>& row) {
        constexpr std::size_t shortest = 8, longest = 32767;
        Rgbe head{};
        if (!peek(head)) return false;
        const bool by_colour =
            row.size() >= shortest && row.size() <= longest && head[0] == 2 && head[1] == 2 && head[2] < 128;
        return by_colour ? next_by_colour(head, row) : next_by_pixel(row);
    }

  private:
    bool peek(Rgbe& out) const {
        if (bytes_.size() - at_ < 4) return false;
        for (std::size_t i = 0; i < 4; ++i) out[i] = static_cast<std::uint8_t>(bytes_[at_ + i]);
        return true;
    }
    std::optional<std::uint8_t> byte() {
        if (at_ >= bytes_.size()) return std::nullopt;
        return static_cast<std::uint8_t>(bytes_[at_++]);
    }

    bool next_by_colour(const Rgbe& head, std::vector<Rgbe>& row) {
        if (head[2] * std::size_t(256) + head[3] != row.size()) return false;
        at_ += 4;
        for (std::size_t c = 0; c < 4; ++c)
            for (std::size_t i = 0; i < row.size();) {
                const auto code = byte();
                if (!code) return false;
                const bool is_run = *code > 128;
                const std::size_t count = is_run ? *code - 128U : *code;
                if (count == 0 || i + count > row.size()) return false;
                std::optional<std::uint8_t> value;
                for (std::size_t k = 0; k < count; ++k) {
                    if (k == 0 || !is_run) value = byte();
                    if (!value) return false;
                    row[i++][c] = *value;
                }
            }
        return true;
    }

    /// Reads a row in the old encoding: (1, 1, 1, n) repeats the previous pixel n times; the k-th such marker of a
    /// series, from 0, counts n 256^k.
    bool next_by_pixel(std::vector<Rgbe>& row) {
        unsigned shift = 0;
        for (std::size_t i = 0; i < row.size();) {
            Rgbe pixel{};
            if (!peek(pixel)) return false;
            at_ += 4;
            if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1 && i > 0) {
                if (shift > 16) return false;
                const std::size_t count = std::size_t(pixel[3]) << shift;
                if (i + count > row.size()) return false;
                std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(i), count, row[i - 1]);
                i += count, shift += 8;
            } else {
                row[i++] = pixel, shift = 0;
            }
        }
        return true;
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
};

}  // namespace

Result<DirectionalPicture> read_directional_hdr(const std::string& path) {
    const Result<std::string> file = read_whole_file(path);
    if (!file) return file.error();
    const Result<HdrHeader> header = read_header(*file, path);
    if (!header) return header.error();
    if (const Result<void> good = check_directional_size(header->width, header->height, path); !good)
        return good.error();
    DirectionalPicture out;
    out.width = static_cast<std::size_t>(header->width), out.height = static_cast<std::size_t>(header->height);
    HdrRows rows(std::string_view(*file).substr(std::min(header->pixels_at, file->size())));
    std::vector<Rgbe> row(out.width);
    // A row that ends early must not make memory for the whole picture.
    for (std::size_t y = 0; y < out.height; ++y) {
        if (!rows.next(row)) return broken(fmt::format("row {} of {} is damaged or missing", y + 1, out.height), path);
        if (header->right_to_left) std::reverse(row.begin(), row.end());
        for (const Rgbe& p : row) {
            std::array<float, 3> colour{};
            // The middle of the interval that a mantissa represents [Ward91].
            for (std::size_t c = 0; c < 3 && p[3] > 0; ++c)
                colour[c] = static_cast<float>(std::ldexp(p[c] + 0.5, p[3] - 136) / header->exposure[c]);
            append_pixel(colour[0], colour[1], colour[2], out);
        }
    }
    if (header->bottom_up) {
        const std::size_t length = out.width * bands;
        for (std::size_t y = 0; y < out.height / 2; ++y)
            std::swap_ranges(out.radiance.begin() + static_cast<std::ptrdiff_t>(y * length),
                             out.radiance.begin() + static_cast<std::ptrdiff_t>((y + 1) * length),
                             out.radiance.begin() + static_cast<std::ptrdiff_t>((out.height - 1 - y) * length));
    }
    return out;
}

}  // namespace exitance
