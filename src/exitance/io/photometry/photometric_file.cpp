#include "exitance/io/photometry/photometric_file.hpp"

#include <fmt/format.h>

#include "exitance/io/files/whole_file.hpp"

namespace exitance {

bool names_photometry(const std::string& path) {
    const std::string end = ending(path);
    return end == ".ies" || end == ".ldt";
}

Result<Photometry> load_photometry(const std::string& path) {
    if (!names_photometry(path))
        return Error{ErrorCode::bad_input, "this kind of photometric file is not known", path,
                     "known endings: .ies, .ldt"};
    const Result<std::string> text = read_whole_file(path);
    if (!text) return Error{text.error().code, text.error().message, path, text.error().hint};
    Result<Photometry> out = ending(path) == ".ies" ? read_ies(*text, path) : read_eulumdat(*text, path);
    constexpr double accepted = 1.02;
    if (out && out->lamp_lumens && out->flux() > accepted * *out->lamp_lumens)
        tell(*out, Finding::Kind::warning, 0,
             fmt::format("its intensities come to {:.4g} lm, more than its lamps' {:.4g} lm", out->flux(),
                         *out->lamp_lumens),
             "the intensities are taken");
    return out;
}

}  // namespace exitance
