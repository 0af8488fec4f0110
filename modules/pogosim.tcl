#%Module
# Pogosim for Environment Modules and Lmod. Install the wheel in an environment of its own, and copy this file to the folder
# pogosim of a folder of MODULEPATH, with the version as its name:
#
#   python3 -m venv /opt/pogosim && /opt/pogosim/bin/pip install dist/pogobot_simulator-*.whl
#   install -D -m 644 modules/pogosim.tcl /opt/modulefiles/pogosim/0.11.0
#
# The environment's folder: change it to yours.
set environment /opt/pogosim

module-whatis "Simulator for swarms of Pogobots"
proc ModulesHelp {} {
    puts stderr "Simulator for swarms of Pogobots: pogosim --help lists its tools, and pogosim new NAME makes a project."
    puts stderr "Programs are compiled with cc and make. python3 is that of the environment, for scripts that import pogosim."
}
conflict pogosim

set simulator [glob $environment/lib/python3*/site-packages/pogosim/simulator]
prepend-path PATH $environment/bin
prepend-path CMAKE_PREFIX_PATH $simulator
prepend-path PKG_CONFIG_PATH $simulator/lib/pkgconfig
