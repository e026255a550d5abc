# Unity builds: each target's files are compiled together by folder, so that what they include is read once.
# sim is left out: what the compiler inlines and fuses there would change with its neighbours, and hashes with it;
# scenes/make is: each of its scenes names its sizes alike.
#
# Names of anonymous namespaces must differ within a folder's batch; a clash is an error of the compiler, never a
# wrong program.
set(SLOSH_UNITY_BATCH 12)

function(slosh_unity target)
  get_target_property(folder ${target} SOURCE_DIR)
  get_target_property(sources ${target} SOURCES)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # To g++ a file that is included is a header, where a type of an anonymous namespace would be a mistake.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
  endif()
  foreach(source IN LISTS sources)
    get_filename_component(source "${source}" ABSOLUTE BASE_DIR "${folder}")
    get_filename_component(place "${source}" DIRECTORY)
    file(RELATIVE_PATH place "${PROJECT_SOURCE_DIR}" "${place}")
    if(NOT source MATCHES "\\.cpp$" OR source MATCHES "^${PROJECT_BINARY_DIR}/" OR place MATCHES "^(sim|scenes/make)(/|$)")
      continue()
    endif()
    string(MAKE_C_IDENTIFIER "${place}" place)
    if(NOT DEFINED count_${place})
      set(count_${place} 0)
    endif()
    math(EXPR batch "${count_${place}} / ${SLOSH_UNITY_BATCH}")
    math(EXPR count_${place} "${count_${place}} + 1")
    set_source_files_properties("${source}" TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP "${place}_${batch}")
  endforeach()
endfunction()

function(slosh_unity_below folder)
  if(folder STREQUAL "${PROJECT_SOURCE_DIR}/sim" OR folder MATCHES "^${PROJECT_SOURCE_DIR}/tests/(sim|cross|fuzz)$")
    return()
  endif()
  get_property(targets DIRECTORY "${folder}" PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(NOT type MATCHES "INTERFACE|UTILITY")
      slosh_unity(${target})
    endif()
  endforeach()
  get_property(folders DIRECTORY "${folder}" PROPERTY SUBDIRECTORIES)
  foreach(below IN LISTS folders)
    slosh_unity_below("${below}")
  endforeach()
endfunction()

slosh_unity_below("${PROJECT_SOURCE_DIR}")
