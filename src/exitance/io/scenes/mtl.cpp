#include "exitance/io/scenes/mtl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {
namespace {

std::string band_name(std::size_t band, std::size_t count) {
    static constexpr const char* rgb[3] = {"red", "green", "blue"};
    if (count == 1) return "all bands";
    return count == 3 ? rgb[band] : fmt::format("band {}", band);
}

/// Values of a file for the bands of this build: as they are, one for all, or three spread over what there is.
Spectrum spread(const std::vector<double>& values) {
    Spectrum out;
    if (values.size() == 3 && bands == 1) return Spectrum((values[0] + values[1] + values[2]) / 3);
    for (std::size_t b = 0; b < bands; ++b) out[b] = values[values.size() == bands ? b : b * values.size() / bands];
    return out;
}

class MtlReader {
  public:
    MtlReader(std::string_view text, const std::string& file, std::vector<Material>& materials,
              std::vector<Finding>& findings)
        : lines_(text), file_(file), materials_(materials), findings_(findings) {}
    void read();

  private:
    void start_material();
    void read_values(const std::string& key, Spectrum Material::*value);
    bool read_number(const std::string& key, std::string_view word, std::vector<double>& out);
    void end_material();
    void find(Finding::Kind kind, int line, std::string message, std::string hint) {
        findings_.push_back({kind, file_, line, std::move(message), std::move(hint)});
    }
    void error(std::string message, std::string hint = "") {
        find(Finding::Kind::error, lines_.number(), std::move(message), std::move(hint));
    }

    TextLines lines_;
    const std::string& file_;
    std::vector<Material>& materials_;
    std::vector<Finding>& findings_;
    Material material_;
    bool open_ = false, has_reflectance_ = false;
    int line_ = 0;
    std::size_t white_materials_ = 0;
    int white_line_ = 0;  ///< Of the first of these,
    std::string white_name_;
};

void MtlReader::read() {
    while (lines_.next()) {
        const std::string_view key = lines_.word();
        if (key == "newmtl")
            start_material();
        else if (key == "Kd" || key == "Ke")
            read_values(std::string(key), key == "Kd" ? &Material::reflectance : &Material::exitance);
    }
    end_material();
    if (white_materials_ > 0)
        find(Finding::Kind::repair, white_line_,
             fmt::format("material '{}'{} has a reflectance Kd of 1: {} takes its place", shown(white_name_),
                         white_materials_ > 1 ? fmt::format(" (and {} more)", white_materials_ - 1) : "",
                         mended_reflectance),
             "nothing reflects all light; at 1 it would never die out");
}

void MtlReader::start_material() {
    end_material();
    material_ = {};
    material_.name = std::string(lines_.rest());
    if (material_.name.empty()) error("'newmtl' without a name");
    open_ = true, has_reflectance_ = false;
    line_ = lines_.number();
}

void MtlReader::end_material() {
    if (!open_) return;
    const auto same = [&](const Material& m) { return m.name == material_.name; };
    if (std::any_of(materials_.begin(), materials_.end(), same)) {
        find(Finding::Kind::warning, line_,
             fmt::format("material '{}' is there already: the first one holds", shown(material_.name)),
             "give it another name");
        return;
    }
    if (!has_reflectance_)
        find(Finding::Kind::warning, line_,
             fmt::format("material '{}' has no Kd: it reflects nothing", shown(material_.name)),
             "add a line 'Kd r g b'");
    materials_.push_back(std::move(material_));
}

/// Reads Kd or Ke of the material at hand; Ke arrives as radiance and is kept as exitance.
void MtlReader::read_values(const std::string& key, Spectrum Material::*value) {
    if (!open_) return error(fmt::format("'{}' comes before any 'newmtl'", key));
    const bool reflectance = key == "Kd";
    has_reflectance_ = has_reflectance_ || reflectance;
    if (lines_.rest().starts_with("spectral") || lines_.rest().starts_with("xyz"))
        return error(
            fmt::format("'{} {}' of material '{}' is not supported", key, lines_.word(), shown(material_.name)),
            "give the values as 'r g b'");
    std::vector<double> values;
    while (!lines_.rest().empty())
        if (!read_number(key, lines_.word(), values)) return;
    if (values.size() != 1 && values.size() != 3 && values.size() != bands)
        return error(fmt::format("material '{}': {} has {} values", shown(material_.name), key, values.size()),
                     "give one or three");
    for (std::size_t b = 0; b < values.size(); ++b) {
        const double v = values[b];
        if (reflectance && !(v >= 0 && v <= whitest_reflectance))
            return error(fmt::format("material '{}': reflectance Kd of {} is {:g}, not in [0, 1)",
                                     shown(material_.name), band_name(b, values.size()), v),
                         "a reflectance is at least 0 and below 1, or light would never die out");
        if (!reflectance && v < 0)
            return error(fmt::format("material '{}': emission Ke of {} is {:g}, below 0", shown(material_.name),
                                     band_name(b, values.size()), v),
                         "emitted radiance is 0 or more, W/(m^2 sr)");
    }
    material_.*value = reflectance ? spread(values) : exitance_of_radiance(spread(values));
    if (reflectance && mend_reflectance(material_.reflectance) && white_materials_++ == 0)
        white_line_ = lines_.number(), white_name_ = material_.name;
}

bool MtlReader::read_number(const std::string& key, std::string_view word, std::vector<double>& out) {
    double v = 0;
    const NumberKind kind = number_of_word(word, v);
    if (kind == NumberKind::finite) return out.push_back(v), true;
    error(fmt::format("material '{}': '{}' in {} is not a {}number", shown(material_.name), shown(word), key,
                      kind == NumberKind::not_finite ? "finite " : ""));
    return false;
}

}  // namespace

void parse_mtl(std::string_view text, const std::string& file, std::vector<Material>& materials,
               std::vector<Finding>& findings) {
    MtlReader(text, file, materials, findings).read();
}

}  // namespace exitance
