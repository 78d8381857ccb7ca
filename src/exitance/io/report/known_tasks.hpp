#pragma once

namespace exitance {

/// Built-in tasks (TOML): requirements of EN 12464-1, in words of this project. Every number is in at
/// least two of the public sources that the comments name; numbers that were found in fewer are left out, even where
/// the standard has one. U_0 of walls and ceilings is 0.10 throughout and not listed.
constexpr const char* known_tasks = R"toml(
edition = "EN 12464-1:2021"

# Offices. Sources: ASR A3.4 and DGUV 215-442 as quoted in public tables (office, technical drawing); Ricoman, "Office
# lighting lux levels"; comparedaylightlamps.com, "Working lighting"; Performance in Lighting, "EN 12464-1" (filing).
[[task]]
name = "office"
words = "writing, reading, work at screens"
Em = 500
U0 = 0.6
UGR = 19
Ra = 80

[[task]]
name = "filing"
words = "filing, copying"
Em = 300

[[task]]
name = "technical-drawing"
words = "drawing by hand"
Em = 750

[[task]]
name = "cad"
words = "design at computers"
Em = 500

[[task]]
name = "meeting"
words = "conferences and meetings"
Em = 500

[[task]]
name = "reception"
words = "front desk"
Em = 300

# Circulation. Sources: Glamox, "Communal and circulation areas for education" (2021); LED industrial illumination,
# "Recommended brightness"; comparedaylightlamps.com (stairs).
[[task]]
name = "corridor"
words = "corridors and areas for walking"
Em = 100

[[task]]
name = "school-stairs"
words = "stairs of schools"
Em = 150

# Shared rooms. Sources: LED industrial illumination, "Recommended brightness according to DIN EN 12464"; public tables
# of lighting programs.
[[task]]
name = "washroom"
words = "cloakrooms, washrooms, toilets"
Em = 200

# Trade. Sources: licht.de, "Lager und Logistik", as quoted in a public table; LED industrial illumination.
[[task]]
name = "packing"
words = "packing and dispatch"
Em = 300

# Industry. Sources: LED industrial illumination; comparedaylightlamps.com, "Working lighting".
[[task]]
name = "rough-assembly"
words = "rough assembly of metal"
Em = 200

[[task]]
name = "medium-assembly"
words = "assembly of medium fineness"
Em = 300

[[task]]
name = "fine-assembly"
words = "fine assembly"
Em = 500

[[task]]
name = "precision-assembly"
words = "very fine assembly"
Em = 750
)toml";

}  // namespace exitance
