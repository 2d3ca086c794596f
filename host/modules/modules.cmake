# OpenImageIO and OpenVDB bring two hundred and fifty libraries with them, which take the dynamic loader 0.2 s. Our own programs load them when
# a file wants them: the parts images and vdb, linked into modules.
file(RELATIVE_PATH folder ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/vitrail)
get_filename_component(VITRAIL_MODULE_FOLDER ${PROJECT_BINARY_DIR}/host/cli/${folder} ABSOLUTE)  # as the program finds it when installed
set(VITRAIL_MODULES "")
foreach(part images vdb)
  if(TARGET vitrail_${part})
    add_library(vitrail_${part}_module MODULE host/modules/${part}_module.cpp)
    target_include_directories(vitrail_${part}_module PRIVATE ${PROJECT_SOURCE_DIR}/host)
    target_link_libraries(vitrail_${part}_module PRIVATE vitrail_${part})
    # Its functions bear the names of those in the program that call them; a call inside the module stays inside.
    target_link_options(vitrail_${part}_module PRIVATE LINKER:-Bsymbolic)
    target_compile_options(vitrail_${part}_module PRIVATE -Wall -Wextra $<$<BOOL:${VITRAIL_WERROR}>:-Werror>)
    set_target_properties(vitrail_${part}_module PROPERTIES OUTPUT_NAME vitrail_${part} PREFIX lib SUFFIX .so
      LIBRARY_OUTPUT_DIRECTORY ${VITRAIL_MODULE_FOLDER})
    list(APPEND VITRAIL_MODULES vitrail_${part}_module)
  endif()
endforeach()

# vitrail_files_on_demand(TARGET): what vitrail::io gives, with the modules instead of the libraries.
function(vitrail_files_on_demand target)
  file(RELATIVE_PATH folder ${CMAKE_CURRENT_BINARY_DIR} ${VITRAIL_MODULE_FOLDER})
  target_sources(${target} PRIVATE ${PROJECT_SOURCE_DIR}/host/modules/on_demand.cpp)
  target_compile_definitions(${target} PRIVATE VITRAIL_MODULE_FOLDER="${folder}" $<$<BOOL:${VITRAIL_BUILD_VDB}>:VITRAIL_HAS_VDB>)
  target_link_libraries(${target} PRIVATE vitrail_files ${CMAKE_DL_LIBS})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/host)
  add_dependencies(${target} ${VITRAIL_MODULES})
endfunction()
