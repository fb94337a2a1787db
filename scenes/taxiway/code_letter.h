/// What the aerodrome code letter says of a taxiway.
#pragma once

#include <array>
#include <stdexcept>
#include <string>

namespace tarmac::scenes {

/// Widths and separations in metres; slopes in percent, upper limits. Sources: ICAO Annex 14 (2018) and EASA
/// CS-ADR-DSN.
struct TaxiwayCode {
  char letter;
  double width_m;
  double width_with_shoulders_m;  ///< = width where the code asks for no shoulders
  double separation_m;            ///< centre line to centre line of a parallel taxiway
  double longitudinal_slope_percent, transverse_slope_percent;
};

inline constexpr std::array<TaxiwayCode, 6> taxiway_codes{{{'A', 7.5, 7.5, 23, 3, 2},
                                                           {'B', 10.5, 10.5, 32, 3, 2},
                                                           {'C', 15, 25, 44, 1.5, 1.5},
                                                           {'D', 23, 34, 63, 1.5, 1.5},
                                                           {'E', 23, 38, 76, 1.5, 1.5},
                                                           {'F', 23, 44, 91, 1.5, 1.5}}};

inline const TaxiwayCode& taxiway_code(const std::string& letter) {
  for (const TaxiwayCode& code : taxiway_codes) {
    if (letter.size() == 1 && letter[0] == code.letter) return code;
  }
  throw std::invalid_argument("there is no aerodrome code letter '" + letter + "'; it is one of A to F");
}

}  // namespace tarmac::scenes
