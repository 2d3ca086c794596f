# vitrail_embed_kernels(OUT): writes every kernels/*/*.cl and include/vitrail/layout/*.h as a byte array into one C++ file, a table of
# name, bytes and length that core/program.cpp expands #include lines from. No other tool is needed. Names: "voxelize/points.cl",
# "lib/bits.cl", "layout/grid.h".
function(vitrail_embed_kernels out)
  file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/kernels/*/*.cl ${PROJECT_SOURCE_DIR}/include/vitrail/layout/*.h)
  list(SORT files)
  add_custom_command(OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DOUT=${out} -DROOT=${PROJECT_SOURCE_DIR} "-DFILES=${files}" -P ${PROJECT_SOURCE_DIR}/kernels/embed.cmake
    DEPENDS ${files} ${PROJECT_SOURCE_DIR}/kernels/embed.cmake VERBATIM
    COMMENT "Embedding kernels")
endfunction()

if(CMAKE_SCRIPT_MODE_FILE)
  set(text "// Generated from kernels/ and include/vitrail/layout/.\n#include \"core/kernel_table.h\"\nnamespace vitrail::inline v0::detail {\nnamespace {\n")
  set(rows "")
  set(number 0)
  foreach(file ${FILES})
    file(RELATIVE_PATH name ${ROOT}/kernels ${file})
    string(REGEX REPLACE "^\\.\\./include/vitrail/" "" name ${name})
    file(READ ${file} hex HEX)
    string(LENGTH "${hex}" length)
    math(EXPR length "${length} / 2")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
    string(REGEX REPLACE "(....................................................................................................)" "\\1\n" bytes "${bytes}")
    string(APPEND text "const unsigned char kFile${number}[] = {\n${bytes}0};\n")
    string(APPEND rows "    {\"${name}\", reinterpret_cast<const char*>(kFile${number}), ${length}},\n")
    math(EXPR number "${number} + 1")
  endforeach()
  string(APPEND text "const KernelFile kFiles[] = {\n${rows}};\n}  // namespace\nstd::span<const KernelFile> kernelTable() { return kFiles; }\n}  // namespace vitrail::v0::detail\n")
  file(WRITE ${OUT} "${text}")
endif()
