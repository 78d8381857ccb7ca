#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/small_scene.hpp"
#include "run_program.hpp"

namespace exitance::test {

using Json = nlohmann::json;

/// Four variants of a small room: two lamps, which only `probe` depends on, for two reflectances. 2 scenes, 2 solves,
/// 4 mixes, 4 probes: 12 steps.
inline constexpr const char* plan_of_room = R"(title = "Lamps and walls"
[scene]
template = ["room.obj", "room.mtl"]
[[vary]]
wall = [0.3, 0.6]
lamp = [0.5, 1]
[[step]]
run = "solve {scene} -o {dir}/room.h5 --error 0.5 --mesh-size 1 --method matrix --light-groups"
[[step]]
run = "mix {dir}/room.h5 lamp={lamp} -o {dir}/mixed.h5 --json"
[[step]]
run = "probe {dir}/mixed.h5 --points points.csv -o {dir}/light.csv"
[[output]]
name = "mean"
file = "light.csv"
column = "E_g"
take = "mean"
[[output]]
name = "E"
file = "light.csv"
column = "E_g"
take = "all"
[[output]]
name = "surfaces"
step = "mix"
json = "surfaces"
)";

/// Writes the plan of the room and its inputs. Returns the path of the plan.
inline std::string write_plan(const TemporaryFolder& folder, std::string text = plan_of_room) {
    write_small_room(folder);
    std::string materials = read_text(folder / "room.mtl");
    materials.replace(materials.find("Kd 0.5 0.4 0.3"), 14, "Kd {{wall}} {{wall}} {{wall}}");
    write_text(folder / "room.mtl", materials);
    write_text(folder / "points.csv", "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n2,1,0,0,0,1\n");
    write_text(folder / "plan.toml", text);
    return folder / "plan.toml";
}

inline std::string with(std::string text, const std::string& old, const std::string& now) {
    return text.replace(text.find(old), old.size(), now);
}

inline Finished sweep(const std::string& plan, std::vector<std::string> words) {
    words.insert(words.begin(), {"sweep", plan});
    return run_program(words);
}

/// The report of `--local N --json`.
inline Json report_of(const Finished& run) {
    return Json::parse(run.out, nullptr, false);
}

/// States of all variants, "done,to do,...".
inline std::string states_of(const std::string& plan) {
    std::string out;
    const Json listed = Json::parse(sweep(plan, {"--list", "--json"}).out, nullptr, false);
    if (!listed.is_object()) return "none";
    for (const Json& variant : listed["variants"])
        out += (out.empty() ? "" : ",") + variant["state"].get<std::string>();
    return out;
}

inline std::string table_of(const TemporaryFolder& folder) {
    EXPECT_EQ(sweep(folder / "plan.toml", {"--collect", "-o", folder / "table.csv"}).status, 0);
    return read_text(folder / "table.csv");
}

}  // namespace exitance::test
