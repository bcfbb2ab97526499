# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs COLMAP and the programs of AxialMVS in sequence, from photographs to a dense cloud. Needs
only the standard library.

reconstruct    photographs taken under water to a cloud: the command axial-reconstruct
colmap_model   photographs to a COLMAP model: the command axial-colmap-model
demo           a simulated scene reconstructed in three ways, compared with the truth
colmap         COLMAP's commands and its models
programs       commands of AxialMVS's programs
running        running commands, with logs
cluster, jobs  reconstruct as a workflow of jobs, for the Snakefile beside the package
one_step       what one job of the workflow does
step_kinds     what is known of every step before it runs
steps          steps that are not repeated when a killed run is started again
"""
