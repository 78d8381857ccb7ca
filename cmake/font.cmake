# Embeds DejaVu Sans, in which pictures are labelled, into the library: sets EXITANCE_FONT_SOURCE. Debian has the font in
# fonts-dejavu-core.
find_file(EXITANCE_FONT DejaVuSans.ttf PATHS /usr/share/fonts/truetype/dejavu /usr/share/fonts/dejavu
    /usr/share/fonts/TTF /usr/share/fonts/dejavu-sans-fonts)
if(NOT EXITANCE_FONT)
    message(FATAL_ERROR "DejaVuSans.ttf is required (Debian's fonts-dejavu-core): give its path as -D EXITANCE_FONT=FILE")
endif()
set(EXITANCE_FONT_SOURCE ${PROJECT_BINARY_DIR}/font.cpp)
file(SHA256 ${EXITANCE_FONT} font_hash)  # so that the compiler cache tells fonts apart
file(CONFIGURE OUTPUT ${EXITANCE_FONT_SOURCE} CONTENT "// SHA-256 of the font: @font_hash@
asm(R\"(
    .section .rodata
    .global exitance_font_begin
    .global exitance_font_end
    .balign 16
exitance_font_begin:
    .incbin \"@EXITANCE_FONT@\"
exitance_font_end:
    .byte 0
    .text
)\");
" @ONLY)
set_source_files_properties(${EXITANCE_FONT_SOURCE} PROPERTIES SKIP_PRECOMPILE_HEADERS ON OBJECT_DEPENDS ${EXITANCE_FONT})
