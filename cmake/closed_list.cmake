# pogosim_choice(NAME DEFAULT "what it is" VALUES...): a cache variable that has one of a few values. Others are an error.
include_guard()

function(pogosim_choice name default description)
    set(${name} "${default}" CACHE STRING "${description}")
    set_property(CACHE ${name} PROPERTY STRINGS ${ARGN})
    if(NOT "${${name}}" IN_LIST ARGN)
        list(JOIN ARGN ", " expected)
        message(FATAL_ERROR "${name} is \"${${name}}\"; expected one of ${expected}: cmake -D${name}=${default}")
    endif()
endfunction()
