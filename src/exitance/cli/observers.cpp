#include "exitance/cli/observers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>

#include "exitance/io/files/text_table.hpp"
#include "exitance/io/scenes/honeybee/honeybee_model.hpp"
#include "exitance/measure/floor_rooms.hpp"
#include "exitance/measure/glare/room_observers.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// Eight directions every 45 degrees, clockwise from y.
constexpr std::array<Vec3, 8> around_the_horizon{
    {{0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {1, -1, 0}, {0, -1, 0}, {-1, -1, 0}, {-1, 0, 0}, {-1, 1, 0}}};

/// Returns the eyes of a Honeybee model's views.
Result<std::vector<Observer>> eyes_of_model(const std::string& path) {
    const HoneybeeModel model = read_honeybee_model(path);
    if (const std::optional<Error> error = model.first_error(path)) return *error;
    std::vector<Observer> out;
    for (const HoneybeeEye& eye : model.eyes) out.push_back({eye.name, eye.at, eye.direction});
    if (out.empty())
        return Error{ErrorCode::bad_input, "holds no views", path,
                     "add a perspective or fisheye view to the model, or name a table of eyes"};
    return out;
}

/// Returns the column at which a row's direction begins: dx, dy, dz or, as in tables of sensors, nx, ny, nz. None if
/// the table has neither. Error: it has only some of the three columns.
Result<std::optional<std::size_t>> find_direction(const NumberTable& table) {
    for (const std::size_t first : {0, 3}) {
        const int count = int(table.has(first)) + int(table.has(first + 1)) + int(table.has(first + 2));
        if (count == 3) return std::optional<std::size_t>(3 + first);
        if (count > 0)
            return table.lines().error("the header has no three columns of a direction",
                                       "name them dx,dy,dz or nx,ny,nz");
    }
    return std::optional<std::size_t>();
}

/// Reads rows with an eye and a direction. `around`: rows without a direction are eight views.
Result<std::vector<Observer>> load_table(const std::string& path, bool around) {
    if (is_honeybee_file(path)) return eyes_of_model(path);
    Result<NumberTable> table = NumberTable::open(path, {"x", "y", "z"}, {"dx", "dy", "dz", "nx", "ny", "nz"});
    if (!table) return table.error();
    const Result<std::optional<std::size_t>> direction = find_direction(*table);
    if (!direction) return direction.error();
    if (!around && !*direction) return table->lines().error("the header has no column dx", "it needs x,y,z,dx,dy,dz");
    std::vector<Observer> out;
    const auto add = [&](const Point& x, const Normal& view) {
        out.push_back({fmt::format("{}", out.size() + 1), x, view});
    };
    for (std::array<double, 9> row{};;) {
        const Result<bool> more = table->next(row);
        if (!more) return more.error();
        if (!*more) break;
        const Point x{row[0], row[1], row[2]};
        const std::size_t first = direction->value_or(3);
        const Vec3 view{row[first], row[first + 1], row[first + 2]};
        if (around && std::isnan(view.x) && std::isnan(view.y) && std::isnan(view.z)) {
            for (const Vec3& way : around_the_horizon) add(x, normalized(way));
            continue;
        }
        if (!(norm(view) > 0))
            return table->lines().error("has a line of sight without a direction",
                                        "its three components must not all be 0");
        add(x, normalized(view));
    }
    if (out.empty())
        return Error{ErrorCode::bad_input, "holds no observers", path,
                     "give the header x,y,z,dx,dy,dz and one row per observer"};
    return out;
}

}  // namespace

Result<std::vector<Observer>> find_observers(const std::string& words, const Stage& stage, const FloorRooms& rooms) {
    if (words == "auto") {
        if (rooms.count() == 0)
            return Error{ErrorCode::usage, "the scene has no floor", "--observers", "give eyes, 'x,y,z dx,dy,dz'"};
        return room_observers(stage, rooms);
    }
    if (words.find_first_not_of("0123456789.,+-eE ") != std::string::npos) return load_table(words, false);
    std::string blank = words;
    std::replace(blank.begin(), blank.end(), ',', ' ');
    std::istringstream in(blank);
    std::vector<double> n;
    for (double value; in >> value;) n.push_back(value);
    const Vec3 view = n.size() == 6 ? Vec3{n[3], n[4], n[5]} : Vec3();
    if (!in.eof() || !(norm(view) > 0))
        return Error{ErrorCode::usage, fmt::format("'{}' is not 'x,y,z dx,dy,dz'", words), "--observers",
                     "an eye in metres and the direction in which it looks"};
    return std::vector<Observer>{{words, {n[0], n[1], n[2]}, normalized(view)}};
}

bool need_rooms(const std::vector<std::string>& observers) {
    return std::find(observers.begin(), observers.end(), "auto") != observers.end();
}

Result<std::vector<Observer>> load_views(const std::string& path) {
    return load_table(path, true);
}

Result<std::vector<Observer>> find_observers(const std::vector<std::string>& all, const Stage& stage,
                                             const FloorRooms& rooms) {
    std::vector<Observer> out;
    for (const std::string& words : all) {
        const Result<std::vector<Observer>> some = find_observers(words, stage, rooms);
        if (!some) return some.error();
        out.insert(out.end(), some->begin(), some->end());
    }
    return out;
}

}  // namespace exitance
