#include "exitance/io/files/radiance_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <iterator>

#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

constexpr std::size_t written_components = 3;

const char* name_of(MatrixFormat format) {
    return format == MatrixFormat::ascii ? "ascii" : format == MatrixFormat::float32 ? "float" : "double";
}

/// The header of a matrix.
struct Header {
    std::size_t rows = 0, columns = 0, components = written_components;
    std::string format = "ascii";
    bool is_big_endian = false;
};

Result<Header> read_header(std::string_view& rest, const std::string& path) {
    Header out;
    const auto bad = [&](std::string message) { return Error{ErrorCode::bad_input, std::move(message), path, ""}; };
    if (!rest.starts_with("#?RADIANCE")) return bad("is not a file of Radiance");
    while (true) {
        const std::size_t end = rest.find('\n');
        if (end == rest.npos) return bad("ends within its header");
        std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line.empty()) break;
        const std::size_t equal = line.find('=');
        if (equal == line.npos) continue;
        const std::string_view key = line.substr(0, equal), value = line.substr(equal + 1);
        if (key == "FORMAT") out.format = value;
        if (key == "BigEndian") out.is_big_endian = value.starts_with('1');
        for (const auto& [name, number] :
             {std::pair{"NROWS", &out.rows}, {"NCOLS", &out.columns}, {"NCOMP", &out.components}})
            if (key == name) {
                constexpr std::size_t max_extent = 1u << 30;
                const auto [stop, error] = std::from_chars(value.data(), value.data() + value.size(), *number);
                if (error != std::errc() || *number == 0 || *number > max_extent)
                    return bad(fmt::format("has an invalid {}: '{}'", name, value));
            }
    }
    if (out.columns == 0) return bad("has no NCOLS");
    return out;
}

/// Reads binary numbers of type T.
template <class T>
std::vector<float> binary_numbers(std::string_view bytes, bool is_big_endian) {
    std::vector<float> out(bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < out.size(); ++i) {
        std::array<char, sizeof(T)> raw{};
        std::memcpy(raw.data(), bytes.data() + i * sizeof(T), sizeof(T));
        if (is_big_endian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
        out[i] = static_cast<float>(std::bit_cast<T>(raw));
    }
    return out;
}

/// Reads numbers in text; stops at the first word that is none.
std::vector<float> text_numbers(std::string_view text) {
    std::vector<float> out;
    const char *at = text.data(), *const end = at + text.size();
    while (true) {
        while (at != end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')) ++at;
        double value = 0;
        const auto [stop, error] = std::from_chars(at, end, value);
        if (error != std::errc()) return out;
        out.push_back(static_cast<float>(value)), at = stop;
    }
}

}  // namespace

Result<RadianceMatrixWriter> RadianceMatrixWriter::create(const std::string& path, MatrixFormat format,
                                                          std::size_t rows, std::size_t columns) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    file->write(fmt::format("#?RADIANCE\nexitance daylight\nNROWS={}\nNCOLS={}\nNCOMP={}\n", rows, columns,
                            written_components));
    if (format != MatrixFormat::ascii)
        file->write(fmt::format("BigEndian={:d}\n", std::endian::native == std::endian::big));
    file->write(fmt::format("FORMAT={}\n\n", name_of(format)));
    return RadianceMatrixWriter(std::move(*file), format);
}

void RadianceMatrixWriter::append_row(std::span<const double> values) {
    std::string text;
    const auto add = [&](const auto& number) {
        for (std::size_t c = 0; c < written_components; ++c)
            text.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    for (const double v : values) {
        if (format_ == MatrixFormat::float32) add(static_cast<float>(v));
        if (format_ == MatrixFormat::float64) add(v);
        if (format_ == MatrixFormat::ascii) fmt::format_to(std::back_inserter(text), "{0:.7g} {0:.7g} {0:.7g}\t", v);
    }
    if (format_ == MatrixFormat::ascii) text += '\n';
    file_.write(text);
}

Result<RadianceMatrix> read_radiance_matrix(const std::string& path) {
    const Result<std::string> content = read_whole_file(path);
    if (!content) return content.error();
    std::string_view rest = *content;
    const Result<Header> header = read_header(rest, path);
    if (!header) return header.error();
    RadianceMatrix out{header->rows, header->columns, header->components, {}};
    if (header->format == "ascii")
        out.values = text_numbers(rest);
    else if (header->format == "float")
        out.values = binary_numbers<float>(rest, header->is_big_endian);
    else if (header->format == "double")
        out.values = binary_numbers<double>(rest, header->is_big_endian);
    else
        return Error{ErrorCode::bad_input, fmt::format("has the format {}", header->format), path,
                     "convert it by rmtxop -fa, -ff or -fd"};
    const std::size_t row = out.columns * out.components;
    if (out.rows == 0) out.rows = out.values.size() / row;
    if (out.rows == 0 || out.values.size() != out.rows * row)
        return Error{ErrorCode::bad_input,
                     fmt::format("holds {} numbers instead of {} x {} x {}", out.values.size(), out.rows, out.columns,
                                 out.components),
                     path, ""};
    return out;
}

}  // namespace exitance
