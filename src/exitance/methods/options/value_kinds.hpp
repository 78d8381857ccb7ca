#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <type_traits>

#include "exitance/base/words.hpp"
#include "exitance/methods/options/option_row.hpp"

namespace exitance::option_values {

// Kinds of option values. Each function returns an OptionValue that reads words into a member of SolveRequest. The
// functions at() select the member.

template <class T>
auto at(T SolveOptions::*member) {
    return [member](auto& request) -> auto& {
        return request.options.*member;
    };
}
template <class T>
auto at(T ClassicalOptions::*member) {
    return [member](auto& request) -> auto& {
        return request.options.classical.*member;
    };
}
template <class T>
auto at(T DiscontinuityChoice::*member) {
    return [member](auto& request) -> auto& {
        return request.options.discontinuity.*member;
    };
}
template <class T>
auto at(T SolveRequest::*member) {
    return [member](auto& request) -> auto& {
        return request.*member;
    };
}

/// A finite number that is the whole word; none otherwise.
std::optional<double> number_in(const std::string& word);
/// Number of bytes in words such as "4G", "500M" or "1048576". K, M, G and T are powers of 1024. None if the word is
/// not a size from 1 to 1e18 bytes.
std::optional<std::size_t> bytes_in(std::string word);
/// Shortest decimal text that reads back as the same number.
std::string text_of(double value);
/// Message of an error.
std::string not_a_number(const std::string& word);

template <class T>
const T* set_value(const T& value, const T& initial) {
    return value == initial ? nullptr : &value;
}
template <class T>
const T* set_value(const std::optional<T>& value, const std::optional<T>&) {
    return value ? &*value : nullptr;
}
template <class T>
const T* present(const T& value) {
    return &value;
}
template <class T>
const T* present(const std::optional<T>& value) {
    return value ? &*value : nullptr;
}

/// A value that `as_word` converts to a word and `as_json` to JSON.
template <class Member, class AsWord, class AsJson>
OptionValue value_of(std::string type, Member member, AsWord as_word, AsJson as_json) {
    OptionValue out;
    out.type = std::move(type);
    out.word = [member, as_word](const SolveRequest& request) -> std::optional<std::string> {
        static const SolveRequest fresh;
        const auto* const set = set_value(member(request), member(fresh));
        return set ? std::optional<std::string>(as_word(*set)) : std::nullopt;
    };
    out.json = [member, as_json](const SolveRequest& request) -> std::string {
        const auto* const value = present(member(request));
        return value ? as_json(*value) : "null";
    };
    return out;
}

template <class Table>
std::string names_of(const Table& table, const char* between) {
    std::string out;
    for (const auto& entry : table) out.append(out.empty() ? "" : between).append(entry.second);
    return out;
}

template <class Table, class Target>
bool choose(const Table& table, const std::string& word, Target& target) {
    for (const auto& [value, name] : table)
        if (name == word) return target = value, true;
    return false;
}

/// A value whose words are the names in a table.
template <class Table, class Member>
OptionValue choice(const Table& table, Member member) {
    const auto name = [&table](const auto& chosen) {
        for (const auto& [value, known] : table)
            if (value == chosen) return std::string(known);
        return std::string();
    };
    OptionValue out =
        value_of(names_of(table, "|"), member, name, [name](const auto& chosen) { return json_text(name(chosen)); });
    out.read = [&table, member](const std::string& word, SolveRequest& request) -> std::string {
        if (choose(table, word, member(request))) return "";
        return "'" + word + "' is not one of " + names_of(table, ", ");
    };
    return out;
}

/// A switch, whose words are "on" and "off".
template <class Member>
OptionValue on_off(Member member) {
    OptionValue out = value_of(
        "on|off", member, [](bool value) { return value ? "on" : "off"; },
        [](bool value) { return value ? "true" : "false"; });
    out.read = [member](const std::string& word, SolveRequest& request) -> std::string {
        if (word != "on" && word != "off") return "must be on or off, not '" + word + "'";
        member(request) = word == "on";
        return "";
    };
    return out;
}

template <class Member>
OptionValue flag(Member member) {
    OptionValue out = on_off(member);
    out.type = "";
    out.read = [member](const std::string&, SolveRequest& request) { return member(request) = true, std::string(); };
    return out;
}

/// A number above 0 and below `limit`.
template <class Member>
OptionValue positive(std::string type, Member member, double limit = HUGE_VAL) {
    OptionValue out = value_of(std::move(type), member, text_of, text_of);
    out.read = [member, limit](const std::string& word, SolveRequest& request) -> std::string {
        const std::optional<double> value = number_in(word);
        if (!value) return not_a_number(word);
        if (!(*value > 0 && *value < limit))
            return limit < HUGE_VAL ? "must be above 0 and below " + text_of(limit) + ", not " + word
                                    : "must be above 0, not " + word;
        member(request) = *value;
        return "";
    };
    return out;
}

/// A whole number of at least `least`.
template <class Member>
OptionValue count(Member member, long long least, double most = 9e15) {
    const auto text = [](auto value) { return std::to_string(value); };
    OptionValue out = value_of("N", member, text, text);
    out.read = [member, least, most](const std::string& word, SolveRequest& request) -> std::string {
        const std::optional<double> value = number_in(word);
        if (!value) return not_a_number(word);
        if (*value != std::floor(*value) || *value < static_cast<double>(least))
            return "must be a whole number from " + std::to_string(least) + ", not " + word;
        if (*value > most) return word + " is too large";
        using Target = std::remove_reference_t<decltype(member(request))>;
        if constexpr (std::is_same_v<Target, int>)
            member(request) = static_cast<int>(*value);
        else
            member(request) = static_cast<std::size_t>(*value);
        return "";
    };
    return out;
}

/// Any text, such as the name of a file.
template <class Member>
OptionValue text(std::string type, Member member) {
    OptionValue out = value_of(
        std::move(type), member, [](const std::string& value) { return value; },
        [](const std::string& value) { return value.empty() ? "null" : json_text(value); });
    out.read = [member](const std::string& word, SolveRequest& request) {
        return member(request) = word, std::string();
    };
    return out;
}

}  // namespace exitance::option_values
