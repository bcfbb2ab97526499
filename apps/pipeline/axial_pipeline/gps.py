# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a photograph says where it was taken."""

from . import exif

GPS_TABLE = 0x8825  # tag of the offset of the GPS table
POSITION = {2, 4, 6}  # tags of latitude, longitude and altitude; COLMAP 3.8 uses only all three


def has_gps(photograph):
    """Whether the Exif data of the file have latitude, longitude and altitude."""
    return bool(exif.table_of(photograph, lambda first: GPS_TABLE in first and
                              POSITION <= first.table(GPS_TABLE).tags()))
