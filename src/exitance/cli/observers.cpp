#include "exitance/cli/observers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "exitance/io/files/text_table.hpp"
#include "exitance/measure/floor_rooms.hpp"
#include "exitance/measure/glare/room_observers.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// Eight directions every 45 degrees, clockwise from y.
constexpr std::array<Vec3, 8> around_the_horizon{
    {{0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {1, -1, 0}, {0, -1, 0}, {-1, -1, 0}, {-1, 0, 0}, {-1, 1, 0}}};

/// Reads rows with an eye and a direction. `around`: rows without a direction are eight views.
Result<std::vector<Observer>> load_table(const std::string& path, bool around) {
    std::vector<std::string> eye{"x", "y", "z"}, direction{"dx", "dy", "dz"};
    if (!around) eye.insert(eye.end(), direction.begin(), direction.end()), direction.clear();
    Result<NumberTable> table = NumberTable::open(path, eye, direction);
    if (!table) return table.error();
    std::vector<Observer> out;
    const auto add = [&](const Point& x, const Normal& view) {
        out.push_back({fmt::format("{}", out.size() + 1), x, view});
    };
    for (std::array<double, 6> row{};;) {
        const Result<bool> more = table->next(row);
        if (!more) return more.error();
        if (!*more) break;
        const Point x{row[0], row[1], row[2]};
        const Vec3 view{row[3], row[4], row[5]};
        if (std::isnan(view.x) && std::isnan(view.y) && std::isnan(view.z)) {
            for (const Vec3& way : around_the_horizon) add(x, normalized(way));
            continue;
        }
        if (!(norm(view) > 0))
            return table->lines().error("has a line of sight without a direction", "dx, dy, dz must not all be 0");
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
