#include "exitance/io/photometry/photometric_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/photometry/luminaire_body.hpp"

namespace exitance {
namespace {

struct Format {
    std::string_view ending;
    Result<Photometry> (*read)(std::string_view text, const std::string& path);
};
constexpr std::array formats{Format{".ies", read_ies}, Format{".ldt", read_eulumdat}};

/// Returns the format that a path's ending names; null for other endings.
const Format* format_of(const std::string& path) {
    const std::string end = ending(path);
    const auto found = std::find_if(formats.begin(), formats.end(), [&](const Format& f) { return f.ending == end; });
    return found == formats.end() ? nullptr : &*found;
}

/// Warns of missing extents that are replaced by defaults.
void warn_of_missing_extent(Photometry& p) {
    if (p.opening.shape == Opening::Shape::point)
        tell(p, Finding::Kind::warning, 0,
             fmt::format("its opening has no size: a cube of {:g} mm is used", 1000 * point_opening_size),
             "UGR treats the luminaire as a small source of 0.005 m^2");
    else if (!(body_size(p.opening) == p.opening.size))
        tell(p, Finding::Kind::warning, 0,
             fmt::format("its opening has no extent in some direction: {:g} cm is used there", 100 * strip_width),
             "this affects the light within some centimetres, and UGR");
}

}  // namespace

bool names_photometry(const std::string& path) {
    return format_of(path) != nullptr;
}

Result<Photometry> load_photometry(const std::string& path) {
    const Format* const format = format_of(path);
    if (!format) {
        std::vector<std::string_view> known;
        for (const Format& f : formats) known.push_back(f.ending);
        return Error{ErrorCode::bad_input, "is not a known kind of photometric file", path,
                     fmt::format("known endings: {}", fmt::join(known, ", "))};
    }
    const Result<std::string> text = read_whole_file(path);
    if (!text) return Error{text.error().code, text.error().message, path, text.error().hint};
    Result<Photometry> out = format->read(*text, path);
    constexpr double accepted = 1.02;
    if (out && out->lamp_lumens && out->flux() > accepted * *out->lamp_lumens)
        tell(*out, Finding::Kind::warning, 0,
             fmt::format("its intensities amount to {:.4g} lm, more than its lamps' {:.4g} lm", out->flux(),
                         *out->lamp_lumens),
             "the intensities are used");
    if (out) warn_of_missing_extent(*out);
    return out;
}

}  // namespace exitance
