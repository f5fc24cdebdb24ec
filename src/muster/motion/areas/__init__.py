"""Ways that cover an area: lanes, their order, and how they are shared among robots.

The free region is cut into lanes, the lanes are joined to cells by the boustrophedon decomposition, the cells are put
in order, and the whole way is cut into parts of equal length. All of it is geometry in the plane, by Shapely.
"""
