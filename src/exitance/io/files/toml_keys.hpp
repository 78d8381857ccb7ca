#pragma once

// toml_parser.cpp contains the functions of toml++, whose headers would otherwise compile them for each file.
#define TOML_HEADER_ONLY 0

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <concepts>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

// Readers of TOML tables. Only the .cpp files that read TOML include this header.

/// Exception of TomlKeys. `read_toml` catches it and returns the error.
struct WrongToml {
    Error error;
};

/// A table of the file: takes keys one by one, and rejects those that are not taken.
class TomlKeys {
  public:
    TomlKeys(const toml::table& table, std::string file) : table_(table), file_(std::move(file)) {}

    [[noreturn]] void fail(const toml::node& at, std::string message, std::string hint = "") const {
        throw WrongToml{{ErrorCode::bad_input, std::move(message), fmt::format("{}:{}", file_, at.source().begin.line),
                         std::move(hint)}};
    }
    const toml::node* find(const std::string& key) {
        known_.insert(key);
        return table_.get(key);
    }
    template <class T>
    void take(const std::string& key, T& target) {
        if (const toml::node* node = find(key)) read(*node, key, target);
    }
    template <class T>
    void need(const std::string& key, T& target) {
        if (!find(key)) fail(table_, fmt::format("'{}' is missing", key));
        take(key, target);
    }
    /// Takes a value by its name. `names`: pairs of a value and its name.
    template <class Value, class Names>
    void take_choice(const std::string& key, const Names& names, Value& target) {
        const toml::node* node = find(key);
        if (!node) return;
        std::string word;
        read(*node, key, word);
        std::vector<std::string_view> known;
        for (const auto& [value, name] : names) {
            if (name == word) return void(target = value);
            known.push_back(name);
        }
        fail(*node, fmt::format("'{}' is not one of {}", word, fmt::join(known, ", ")));
    }
    void finish() const {
        for (const auto& [key, node] : table_)
            if (!known_.contains(std::string(key.str())))
                fail(node, fmt::format("'{}' is not known here", key.str()),
                     fmt::format("known are {}", fmt::join(known_, ", ")));
    }
    const std::string& file() const { return file_; }
    const toml::table& table() const { return table_; }

  private:
    void read(const toml::node& node, const std::string& key, std::string& target) const {
        const std::optional<std::string> value = node.value_exact<std::string>();
        if (!value) fail(node, fmt::format("'{}' is not text in quotes", key));
        target = *value;
    }
    void read(const toml::node& node, const std::string& key, bool& target) const {
        const std::optional<bool> value = node.value_exact<bool>();
        if (!value) fail(node, fmt::format("'{}' is not true or false", key));
        target = *value;
    }
    void read(const toml::node& node, const std::string& key, double& target) const {
        const std::optional<double> value = node.is_boolean() ? std::nullopt : node.value<double>();
        if (!value) fail(node, fmt::format("'{}' is not a number", key));
        target = *value;
    }
    template <class Whole>
    requires std::same_as<Whole, int> || std::same_as<Whole, std::size_t>
    void read(const toml::node& node, const std::string& key, Whole& target) const {
        const std::optional<std::int64_t> value = node.value_exact<std::int64_t>();
        if (!value || *value < 0 || *value > 1'000'000'000) fail(node, fmt::format("'{}' is not a count", key));
        target = static_cast<Whole>(*value);
    }
    template <class T>
    void read(const toml::node& node, const std::string& key, std::vector<T>& target) const {
        const toml::array* array = node.as_array();
        if (!array) fail(node, fmt::format("'{}' is not a list", key));
        target.clear();
        for (const toml::node& entry : *array) read(entry, key, target.emplace_back());
    }
    void read(const toml::node& node, const std::string& key,
              std::map<std::string, std::vector<std::string>>& target) const {
        const toml::table* table = node.as_table();
        if (!table) fail(node, fmt::format("'{}' is not of the form {{ column = \"text\" }}", key));
        for (const auto& [column, entry] : *table) {
            std::vector<std::string>& texts = target[std::string(column.str())];
            if (entry.is_array())
                read(entry, key, texts);
            else
                read(entry, key, texts.emplace_back());
        }
    }
    void read(const toml::node& node, const std::string& key, std::map<std::string, std::string>& target) const {
        const toml::table* table = node.as_table();
        if (!table) fail(node, fmt::format("'{}' is not of the form {{ name = \"text\" }}", key));
        for (const auto& [name, entry] : *table) read(entry, key, target[std::string(name.str())]);
    }

    const toml::table& table_;
    std::string file_;
    std::set<std::string> known_;
};

/// Parses a text in TOML and returns read(table), or the error of the text or of `read`.
/// file  name in errors
/// hint  function that returns the hint for the description of an error of syntax
template <class Read, class Hint>
auto read_toml(const std::string& text, const std::string& file, const Read& read, const Hint& hint)
    -> Result<decltype(read(std::declval<const toml::table&>()))> {
    try {
        return read(toml::parse(text, file));
    } catch (const WrongToml& wrong) {
        return wrong.error;
    } catch (const toml::parse_error& wrong) {
        return Error{ErrorCode::bad_input, std::string(wrong.description()),
                     fmt::format("{}:{}", file, wrong.source().begin.line), hint(wrong.description())};
    }
}

/// Reads TOML with the address of the language's description as the hint.
template <class Read>
auto read_toml(const std::string& text, const std::string& file, const Read& read) {
    return read_toml(text, file, read, [](std::string_view) -> std::string { return "see https://toml.io"; });
}

/// Calls read(TomlKeys&) for each of the tables `[[key]]`.
template <class Read>
void for_each_table(TomlKeys& keys, const std::string& key, const Read& read) {
    const toml::node* node = keys.find(key);
    if (!node) return;
    const std::string hint = fmt::format("write [[{}]] above each of them", key);
    if (node->is_table())
        keys.fail(*node, fmt::format("'{0}' is a list of tables, so [{0}] must be [[{0}]]", key), hint);
    const toml::array* array = node->as_array();
    if (!array) keys.fail(*node, fmt::format("'{}' is not a list of tables: [[{}]]", key, key), hint);
    for (const toml::node& entry : *array) {
        const toml::table* table = entry.as_table();
        if (!table) keys.fail(entry, fmt::format("'{}' is not a list of tables: [[{}]]", key, key), hint);
        TomlKeys inner(*table, keys.file());
        read(inner);
    }
}

/// Reads the tables `[[key]]` into a list, each by read(TomlKeys&, T&).
template <class T, class Read>
void take_list(TomlKeys& keys, const std::string& key, std::vector<T>& target, const Read& read) {
    for_each_table(keys, key, [&](TomlKeys& inner) {
        read(inner, target.emplace_back());
        inner.finish();
    });
}

}  // namespace exitance
