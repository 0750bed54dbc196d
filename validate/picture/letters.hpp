#pragma once

#include <array>
#include <string_view>

/// Letters of 5 × 9 cells for pictures of pixels: seven rows on the line, two below it.
namespace detp::validate {

inline constexpr int letter_width = 5;
inline constexpr int letter_rows = 9;
inline constexpr int letter_rows_above = 7;

/// Drawn by hand: '#' is ink; each letter takes six columns, the last one empty.
struct LetterSheet {
  std::string_view letters;
  std::array<std::string_view, letter_rows> rows;
};

// clang-format off
inline constexpr std::array<LetterSheet, 4> letter_sheets{{
    {"0123456789.,-+%",
     {" ###    #    ###  #####    #  #####  ###  #####  ###   ###                          ##  # ",
      "#   #  ##   #   #    #    ##  #     #         # #   # #   #                     #   ##  # ",
      "#  ##   #       #   #    # #  ####  #        #  #   # #   #                     #      #  ",
      "# # #   #      #     #  #  #      # ####    #    ###   ####             ##### #####   #   ",
      "##  #   #     #       # #####     # #   #   #   #   #     #                     #    #    ",
      "#   #   #    #    #   #    #  #   # #   #   #   #   #     #  ##    ##           #   #  ## ",
      " ###  ##### #####  ###     #   ###   ###    #    ###   ###   ##    ##               #  ## ",
      "                                                                    #                     ",
      "                                                                   #                      "}},
    {"abcdefghijklm",
     {"      #               #         ##        #       #      #  #      ##         ",
      "      #               #        #          #                 #       #         ",
      " ###  ####   ###   ####  ###  ###    #### ####   ##     ##  #  #    #   ## #  ",
      "    # #   # #     #   # #   #  #    #   # #   #   #      #  # #     #   # # # ",
      " #### #   # #     #   # #####  #    #   # #   #   #      #  ##      #   # # # ",
      "#   # #   # #     #   # #      #    #   # #   #   #      #  # #     #   # # # ",
      " #### ####   ###   ####  ###   #     #### #   #  ###     #  #  #   ###  # # # ",
      "                                        #                #                    ",
      "                                     ###               ##                     "}},
    {"nopqrstuvwxyz",
     {"                                     #                                        ",
      "                                     #                                        ",
      "####   ###  ####   #### # ##   #### ###   #   # #   # #   # #   # #   # ##### ",
      "#   # #   # #   # #   # ##    #      #    #   # #   # # # #  # #  #   #    #  ",
      "#   # #   # #   # #   # #      ###   #    #   #  # #  # # #   #   #   #   #   ",
      "#   # #   # #   # #   # #         #  #    #   #  # #  # # #  # #  #   #  #    ",
      "#   #  ###  ####   #### #     ####    ##   ####   #    # #  #   #  #### ##### ",
      "            #         #                                               #       ",
      "            #         #                                            ###        "}},
    {"()/:_=<>@",
     {"  #     #       #                                ###  ",
      " #       #      #                      #   #    #   # ",
      " #       #     #   ##         #####   #     #   # ### ",
      " #       #    #    ##                #       #  # # # ",
      " #       #   #                #####   #     #   # ### ",
      " #       #  #      ##                  #   #    #     ",
      "  #     #   #      ##                            #### ",
      "                        #####                         ",
      "                                                      "}},
}};
// clang-format on

}  // namespace detp::validate
