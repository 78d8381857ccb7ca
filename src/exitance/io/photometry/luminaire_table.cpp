#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/photometry/placed_luminaire.hpp"

namespace exitance {
namespace {

constexpr std::array<const char*, 12> columns{
    "file", "x", "y", "z", "aim_x", "aim_y", "aim_z", "rotation", "dimming", "lumens", "maintenance_factor", "group"};
constexpr std::size_t required = 4;

std::string trimmed_field(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

/// Splits a line at commas. A comma in double quotes is text, and two quotes in such a field are one.
std::vector<std::string> fields_of(std::string_view line) {
    std::vector<std::string> out;
    std::string field;
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
            field += '"', ++i;
        else if (c == '"')
            quoted = !quoted;
        else if (c == ',' && !quoted)
            out.push_back(trimmed_field(field)), field.clear();
        else
            field += c;
    }
    out.push_back(trimmed_field(field));
    return out;
}

/// Fields of one row, in the order of `columns`; empty if missing.
using Row = std::array<std::string, columns.size()>;

class TableReader {
  public:
    TableReader(LineReader lines, const std::string& path) : lines_(std::move(lines)), path_(path) {}
    Result<std::vector<PlacedLuminaire>> read();

  private:
    Result<void> read_header(std::string_view header);
    Result<PlacedLuminaire> luminaire_of(const Row& row);
    Result<double> number(const Row& row, std::size_t column, double otherwise, double least, double most);

    LineReader lines_;
    const std::string& path_;
    std::vector<std::size_t> slots_;  ///< Index into `columns` per column of the file.
};

Result<void> TableReader::read_header(std::string_view header) {
    if (header.starts_with("\xef\xbb\xbf")) header.remove_prefix(3);
    for (const std::string& name : fields_of(header)) {
        const auto known = std::find(columns.begin(), columns.end(), name);
        if (known == columns.end())
            return lines_.error(fmt::format("there is no column '{}'", shown(name)),
                                fmt::format("known: {}", fmt::join(columns, ", ")));
        const auto slot = static_cast<std::size_t>(known - columns.begin());
        if (std::find(slots_.begin(), slots_.end(), slot) != slots_.end())
            return lines_.error(fmt::format("the column '{}' occurs twice", name));
        slots_.push_back(slot);
    }
    for (std::size_t i = 0; i < required; ++i)
        if (std::find(slots_.begin(), slots_.end(), i) == slots_.end())
            return lines_.error(fmt::format("the header has no column {}", columns[i]), "it needs file,x,y,z");
    return {};
}

Result<double> TableReader::number(const Row& row, std::size_t column, double otherwise, double least, double most) {
    const std::string& text = row[column];
    if (text.empty() && column >= required) return otherwise;
    const std::optional<double> value = parse_number(text);
    if (!value || !std::isfinite(*value))
        return lines_.error(fmt::format("'{}' in column {} is not a number", shown(text), columns[column]));
    if (*value < least || *value > most)
        return lines_.error(fmt::format("{} {} is not between {:g} and {:g}", columns[column], text, least, most));
    return *value;
}

Result<PlacedLuminaire> TableReader::luminaire_of(const Row& row) {
    constexpr double max_coordinate = 1e9;
    PlacedLuminaire out;
    if (row[0].empty()) return lines_.error("column file is empty");
    out.path = beside(path_, row[0]);
    out.group = row[11], out.file = path_, out.line = lines_.line();
    Vec3 direction;
    double rotation = 0, lumens = 0;
    const bool has_aim = !row[4].empty() || !row[5].empty() || !row[6].empty();
    struct Field {
        double* target;
        std::size_t column;
        double otherwise, least, most;
    };
    for (const Field& f : {Field{&out.position.x, 1, 0, -max_coordinate, max_coordinate},
                           Field{&out.position.y, 2, 0, -max_coordinate, max_coordinate},
                           Field{&out.position.z, 3, 0, -max_coordinate, max_coordinate},
                           Field{&direction.x, 4, 0, -max_coordinate, max_coordinate},
                           Field{&direction.y, 5, 0, -max_coordinate, max_coordinate},
                           Field{&direction.z, 6, has_aim ? 0.0 : -1.0, -max_coordinate, max_coordinate},
                           Field{&rotation, 7, 0, -3600, 3600}, Field{&out.dimming, 8, 1, 0, 1},
                           Field{&lumens, 9, 0, 0, 1e9}, Field{&out.maintenance, 10, 1, 0, 1}}) {
        const Result<double> value = number(row, f.column, f.otherwise, f.least, f.most);
        if (!value) return value.error();
        *f.target = *value;
    }
    if (!row[9].empty()) out.lumens = lumens;
    if (!(norm(direction) > 0)) return lines_.error("the aim has no direction", "aim_x,aim_y,aim_z: 0,0,-1 is down");
    aim(out, normalized(direction), rotation);
    return out;
}

Result<std::vector<PlacedLuminaire>> TableReader::read() {
    constexpr std::size_t max_luminaires = 1'000'000;
    std::vector<PlacedLuminaire> out;
    bool is_header = true;
    while (const auto line = lines_.next_content()) {
        if (is_header) {
            if (const Result<void> header = read_header(*line); !header) return header.error();
            is_header = false;
            continue;
        }
        const std::vector<std::string> fields = fields_of(*line);
        if (fields.size() > slots_.size())
            return lines_.error(fmt::format("there are {} fields under {} columns", fields.size(), slots_.size()));
        Row row;
        for (std::size_t i = 0; i < fields.size(); ++i) row[slots_[i]] = fields[i];
        Result<PlacedLuminaire> luminaire = luminaire_of(row);
        if (!luminaire) return luminaire.error();
        out.push_back(std::move(*luminaire));
        if (out.size() > max_luminaires) return lines_.error("there are more than a million luminaires");
    }
    if (lines_.failed()) return lines_.read_error();
    if (is_header) return lines_.error("is empty: there is no header line", "begin with file,x,y,z");
    if (out.empty()) return lines_.error("holds no luminaires");
    return out;
}

}  // namespace

void aim(PlacedLuminaire& l, const Normal& direction, double rotation) {
    const double a = rotation * pi / 180, c = std::cos(a), s = std::sin(a);
    l.x = {c, s, 0}, l.y = {-s, c, 0}, l.z = {0, 0, 1};
    // The shortest rotation takes the vertical to -direction. A luminaire that points straight up is rotated about x.
    const Normal up = -direction;
    const Vec3 axis = cross(Vec3{0, 0, 1}, up);
    const double sine = norm(axis);
    if (sine < 1e-12) {
        if (up.z < 0)
            for (Vec3* v : {&l.x, &l.y, &l.z}) *v = {v->x, -v->y, -v->z};
        return;
    }
    const Vec3 k = axis / sine;
    for (Vec3* v : {&l.x, &l.y, &l.z})
        *v = normalized(up.z * *v + sine * cross(k, *v) + (1 - up.z) * dot(k, *v) * k);  // Rodrigues' rotation formula
}

Result<std::vector<PlacedLuminaire>> load_luminaire_table(const std::string& path) {
    Result<LineReader> lines = LineReader::open(path);
    if (!lines) return lines.error();
    return TableReader(std::move(*lines), path).read();
}

}  // namespace exitance
