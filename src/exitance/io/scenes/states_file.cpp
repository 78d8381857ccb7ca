#include "exitance/io/scenes/states_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/toml_keys.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/honeybee/honeybee_model.hpp"
#include "exitance/io/scenes/honeybee/honeybee_states.hpp"
#include "exitance/io/scenes/pane_choice.hpp"

namespace exitance {
namespace {

/// Reads the groups of a file of states.
class StatesReader {
  public:
    StatesReader(const std::string& path, const StatesInput& input) : path_(path), in_(input) {
        out_.group_of_pane.assign(input.scene.panes().size(), PaneGroups::no_group);
    }

    DaylightStates read(const toml::table& table) {
        TomlKeys keys(table, path_);
        for_each_table(keys, "group", [&](TomlKeys& group) { read_group(group), group.finish(); });
        take_list(keys, "variant", out_.variants,
                  [&](TomlKeys& variant, GlassVariant& target) { read_variant(variant, target); });
        keys.finish();
        if (out_.groups.empty()) keys.fail(table, "has no groups of panes", "begin each with [[group]]");
        const bool has_all_light = out_.groups.front().has_all_light;
        out_.has_all_panes = !has_all_light && std::find(out_.group_of_pane.begin(), out_.group_of_pane.end(),
                                                         PaneGroups::no_group) == out_.group_of_pane.end();
        return std::move(out_);
    }

  private:
    /// The path of a file that the file of states names, relative to its folder.
    std::string beside(const std::string& name) const {
        return (std::filesystem::path(path_).parent_path() / name).string();
    }

    void read_group(TomlKeys& keys) {
        PaneGroup group;
        keys.need("name", group.name);
        if (out_.groups.size() == PaneGroups::max_groups)
            keys.fail(keys.table(), fmt::format("exceeds the limit of {} groups", PaneGroups::max_groups));
        for (const PaneGroup& other : out_.groups)
            if (other.name == group.name) keys.fail(keys.table(), fmt::format("'{}' names two groups", group.name));
        PaneChoice choice = read_choice(keys);
        std::string dynamic;
        keys.take("dynamic_group", dynamic);
        HoneybeeStates of_model;
        if (!dynamic.empty()) of_model = take_dynamic(keys, dynamic, choice, group);
        if (!group.has_all_light) add_panes(keys, group.name, choice);
        for_each_table(keys, "state", [&](TomlKeys& state) {
            group.states.push_back(read_state(state, group.states.empty(), choice)), state.finish();
        });
        if (group.states.size() < 2)
            keys.fail(keys.table(), fmt::format("group '{}' has fewer than two states", group.name),
                      "give each a [[group.state]] with a name; the first is the scene as it is");
        if (group.states.size() > max_states) keys.fail(keys.table(), "a group has at most 255 states");
        read_rule(keys, group);
        add_scenes(of_model, choice, group);
        out_.groups.push_back(std::move(group));
        if (out_.groups.size() > 1) check_light(keys);
    }

    /// Throws an error if a group has all light, which no other group may change.
    void check_light(const TomlKeys& keys) const {
        for (const PaneGroup& group : out_.groups)
            if (group.has_all_light)
                keys.fail(keys.table(),
                          fmt::format("group '{}' has shades, which change the light of all groups", group.name),
                          "give it a file and a run of its own");
    }

    void read_variant(TomlKeys& keys, GlassVariant& variant) const {
        check_light(keys);
        keys.need("name", variant.name), keys.need("factors", variant.factors);
        if (variant.factors.size() != out_.groups.size() ||
            !std::all_of(variant.factors.begin(), variant.factors.end(), [](double f) { return f >= 0 && f <= 1; }))
            keys.fail(*keys.find("factors"),
                      fmt::format("'factors' must be a number from 0 to 1 for each of the {} groups above it",
                                  out_.groups.size()));
    }

    /// Chooses the panes of a dynamic group of the scene's Honeybee model, and takes its states, named by their
    /// numbers.
    HoneybeeStates take_dynamic(TomlKeys& keys, const std::string& name, PaneChoice& choice, PaneGroup& group) const {
        const auto model = std::find_if(in_.files.begin(), in_.files.end(), is_honeybee_file);
        if (model == in_.files.end())
            keys.fail(keys.table(), "'dynamic_group' needs a Honeybee model (.hbjson) as scene",
                      "choose panes by materials, objects or a box");
        const bool has_states = keys.find("state") != nullptr;
        Result<HoneybeeStates> found = find_honeybee_states(read_honeybee_model(*model), name, has_states);
        if (!found) keys.fail(keys.table(), found.error().message, found.error().hint);
        group.has_all_light = found->has_shades;
        if (has_states && found->has_shades)
            keys.fail(*keys.find("state"), fmt::format("'{}' has shades, whose states are those of the model", name),
                      "leave [[group.state]] out");
        if (found->has_shades && !(choice.objects.empty() && choice.materials.empty() && !choice.box))
            keys.fail(keys.table(), fmt::format("'{}' has shades, so that the group cannot have further panes", name),
                      "leave materials, objects and box out");
        choice.objects.insert(choice.objects.end(), found->objects.begin(), found->objects.end());
        for (std::size_t k = 0; k < found->factors.size(); ++k)
            group.states.push_back({fmt::format("{}", k), found->factors[k], {}});
        return std::move(*found);
    }

    /// Adds the scenes of those states of a Honeybee model that need one and that the rule may choose.
    void add_scenes(const HoneybeeStates& of_model, const PaneChoice& choice, PaneGroup& group) {
        std::map<std::size_t, std::size_t> scenes;  // by HoneybeeStates::scene
        for (std::size_t k = 0; k < of_model.scene.size(); ++k) {
            const std::size_t scene = of_model.scene[k];
            const std::vector<std::uint8_t>& plan = group.rule.schedule;
            const bool is_possible =
                group.rule.kind != StateRule::Kind::schedule || std::find(plan.begin(), plan.end(), k) != plan.end();
            if (scene == 0 || !is_possible) continue;
            if (!scenes.contains(scene)) {
                LoadOptions load = in_.load;
                load.honeybee_states = of_model.choices(k);
                scenes[scene] = add_scene(in_.files, load, choice);
            }
            group.states[k].scene = scenes[scene];
        }
    }

    static PaneChoice read_choice(TomlKeys& keys) {
        PaneChoice out;
        keys.take("materials", out.materials), keys.take("objects", out.objects);
        std::vector<double> box;
        keys.take("box", box);
        if (box.empty()) return out;
        if (box.size() != 6 || !(box[0] <= box[3] && box[1] <= box[4] && box[2] <= box[5]))
            keys.fail(*keys.find("box"), "'box' is not of the form [x0, y0, z0, x1, y1, z1] with x0 <= x1 and so on");
        out.box.emplace();
        out.box->add(Point{box[0], box[1], box[2]}), out.box->add(Point{box[3], box[4], box[5]});
        return out;
    }

    void add_panes(const TomlKeys& keys, const std::string& name, const PaneChoice& choice) {
        const std::vector<bool> chosen = chosen_panes(choice, in_.scene, in_.panes);
        bool is_empty = true;
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            if (!chosen[i]) continue;
            std::int32_t& group = out_.group_of_pane[i];
            if (group >= 0)
                keys.fail(keys.table(),
                          fmt::format("groups '{}' and '{}' have a pane in common",
                                      out_.groups[static_cast<std::size_t>(group)].name, name),
                          "choose the panes of one of them by other materials, objects or a box");
            group = static_cast<std::int32_t>(out_.groups.size()), is_empty = false;
        }
        if (is_empty)
            keys.fail(keys.table(), fmt::format("group '{}' has none of the scene's {} panes", name, chosen.size()),
                      known_names());
    }

    /// The names by which panes can be chosen.
    std::string known_names() const {
        if (in_.panes.empty()) return "choose panes by a box; this scene has no names of panes";
        std::set<std::string> materials;
        for (const NamedPane& pane : in_.panes) materials.insert(pane.material);
        return fmt::format("panes have the materials {}", fmt::join(materials, ", "));
    }

    PaneState read_state(TomlKeys& keys, bool is_first, const PaneChoice& choice) {
        PaneState out;
        keys.need("name", out.name);
        keys.take("factor", out.factor);
        if (!(out.factor >= 0 && out.factor <= 1))
            keys.fail(*keys.find("factor"), fmt::format("'factor' must be from 0 to 1, not {}", out.factor));
        std::vector<std::string> files;
        keys.take("files", files);
        if (is_first && (out.factor != 1 || !files.empty()))
            keys.fail(keys.table(), "the first state has a factor or files",
                      "the first state is the scene as it is: put another before this one");
        if (!files.empty()) out.scene = add_scene(keys, files, choice);
        return out;
    }

    std::size_t add_scene(const TomlKeys& keys, const std::vector<std::string>& added, const PaneChoice& choice) {
        if (in_.panes.empty())
            keys.fail(keys.table(), "a solution has no scene files to which those of a state could be added",
                      "give the scene files instead of the solution");
        std::vector<std::string> files(in_.files.begin(), in_.files.end());
        for (const std::string& file : added) files.push_back(beside(file));
        return add_scene(files, in_.load, choice);
    }

    std::size_t add_scene(std::span<const std::string> files, const LoadOptions& load, const PaneChoice& choice) {
        LoadedScene loaded = load_scene(files, load);
        if (!loaded.scene) throw WrongToml{loaded.scene.error()};
        std::vector<std::int32_t> group_of_pane;
        for (const bool is_chosen : chosen_panes(choice, *loaded.scene, loaded.panes))
            group_of_pane.push_back(is_chosen ? 0 : PaneGroups::no_group);
        out_.scenes.push_back({std::move(*loaded.scene), out_.groups.size(), std::move(group_of_pane)});
        return out_.scenes.size() - 1;
    }

    void read_rule(TomlKeys& keys, PaneGroup& group) const {
        std::string rule;
        keys.need("rule", rule);
        if (rule == "lm83") {
            group.rule.kind = StateRule::Kind::sunlight;
        } else if (rule == "illuminance") {
            group.rule.kind = StateRule::Kind::illuminance;
            read_limits(keys, group);
        } else if (rule == "schedule") {
            std::string file;
            keys.need("schedule", file);
            read_schedule(beside(file), group);
        } else if (rule == "constant") {
            std::string state;
            keys.need("stays", state);
            group.rule.schedule.assign(in_.hours, number_of(keys, group, state));
        } else {
            keys.fail(*keys.find("rule"), fmt::format("'{}' is not a rule", rule),
                      "rules: lm83, illuminance, schedule, constant");
        }
    }

    static std::uint8_t number_of(const TomlKeys& keys, const PaneGroup& group, const std::string& name) {
        for (std::size_t k = 0; k < group.states.size(); ++k)
            if (group.states[k].name == name) return static_cast<std::uint8_t>(k);
        keys.fail(keys.table(), fmt::format("group '{}' has no state '{}'", group.name, name));
    }

    void read_limits(TomlKeys& keys, PaneGroup& group) const {
        StateRule& rule = group.rule;
        keys.need("sensors", rule.sensors), keys.need("limits", rule.limits);
        if (rule.limits.size() + 1 != group.states.size() || !std::is_sorted(rule.limits.begin(), rule.limits.end()))
            keys.fail(*keys.find("limits"), fmt::format("'limits' must be {} ascending illuminances for {} states",
                                                        group.states.size() - 1, group.states.size()));
        if (rule.sensors.empty()) keys.fail(*keys.find("sensors"), "'sensors' is empty");
        for (const std::size_t sensor : rule.sensors)
            if (sensor >= in_.sensors)
                keys.fail(*keys.find("sensors"),
                          fmt::format("there is no sensor {}: {} sensors are counted from 0", sensor, in_.sensors));
    }

    void read_schedule(const std::string& file, PaneGroup& group) const {
        Result<NumberTable> table = NumberTable::open(file, {group.name});
        if (!table) throw WrongToml{table.error()};
        std::vector<double> row(1);
        for (;;) {
            const Result<bool> more = table->next(row);
            if (!more) throw WrongToml{more.error()};
            if (!*more) break;
            const double state = row[0];
            if (!(state >= 0 && state < static_cast<double>(group.states.size()) && state == std::floor(state)))
                throw WrongToml{table->lines().error(
                    fmt::format("{} is not the number of a state of group '{}'", state, group.name),
                    "states are counted from 0")};
            group.rule.schedule.push_back(static_cast<std::uint8_t>(state));
        }
        if (group.rule.schedule.size() != in_.hours)
            throw WrongToml{
                {ErrorCode::bad_input,
                 fmt::format("has {} rows for {} hours of the weather", group.rule.schedule.size(), in_.hours), file,
                 "give a row per hour"}};
    }

    static constexpr std::size_t max_states = 255;  ///< derived from the range of 8 bits

    const std::string& path_;
    const StatesInput& in_;
    DaylightStates out_;
};

}  // namespace

Result<DaylightStates> read_states(const std::string& path, const StatesInput& input) {
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text.error();
    return read_toml(*text, path, [&](const toml::table& table) { return StatesReader(path, input).read(table); });
}

}  // namespace exitance
