#pragma once

#include <set>
#include <string>
#include <vector>

#include "exitance/io/scenes/honeybee/honeybee_modifiers.hpp"
#include "exitance/io/scenes/json_members.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Returns the properties of an object for Radiance.
const Json& honeybee_radiance(const Json& object);

/// Returns the name of a material that is given by its name or as a whole object; empty for neither.
std::string honeybee_modifier_name(const Json& value);

/// The materials and modifier sets of a Honeybee model, and the rules by which objects get their materials.
class HoneybeeMaterials {
  public:
    /// `path`: name of the file in findings.
    /// Errors, and warnings about omitted parts, are appended to `findings`.
    HoneybeeMaterials(const std::string& path, std::vector<Finding>& findings) : path_(path), findings_(findings) {}

    /// Reads the materials and sets from a model's properties for Radiance. Returns the materials in the words of
    /// Radiance, each name once, and Honeybee's generic materials.
    std::vector<RadPrimitive> read(const Json& properties);

    /// Returns the modifier set of this name, or null.
    const HoneybeeModifierSet* find_set(const std::string& name) const;

    /// Returns the name of an object's material: that of its state, its own, or that of the sets.
    ///
    /// key  entry of modifier sets, such as "wall_set.exterior_modifier"
    /// set  modifier set of the object's room; null outside of rooms
    std::string modifier_of(const Json& object, std::size_t state, const std::string& key,
                            const HoneybeeModifierSet* set) const;

    /// Returns the name of an entry's material, in Honeybee's order: the room's set, the model's set, the generic set.
    std::string from_sets(const std::string& key, const HoneybeeModifierSet* set) const;

  private:
    void read_set(const Json& json, HoneybeeModifierSet& set);
    void add_modifiers(const Json& list);
    void add_modifier(const Json& json);
    void take_refraction(const Json& json, RadPrimitive& p);
    void add_bsdf(const Json& json, RadPrimitive& p);
    void error(std::string message, std::string hint = "");
    void warn(std::string message, std::string hint = "");

    const std::string& path_;
    std::vector<Finding>& findings_;
    std::vector<RadPrimitive> modifiers_;
    std::set<std::string> names_;  ///< Names of `modifiers_`, and of void materials.
    HoneybeeModifierSet global_;
    std::map<std::string, HoneybeeModifierSet> sets_;
};

}  // namespace exitance
