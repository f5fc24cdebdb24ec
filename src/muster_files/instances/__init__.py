"""Instance files of the field as missions, their matrices as travel tables, and solutions (`.sol`) as plans.

TSPLIB, VRPLIB, and the layouts of Solomon, of Li and Lim, of Cordeau and of electric vehicle routing.
"""
