"""Kinds of failure by name, and the numbers that tell them apart.

The names and their order follow figure 1 of Vardon, Wang and Hicks (2017), the words Hungr, Leroueil and Picarelli
(2014). `quantities.failure_mode` measures a state and decides by these numbers.
"""

MODES = (  # the codes in results are the places in this list
    "no_failure",
    "rotational",
    "translational",
    "superficial",
    "earthflow",
    "retrogressive",
    "spread",
)

FLOW_STRAIN = 1.0  # plastic strain from which soil has lost its shape: it is several times what softens it [-]
FLOWED_SHARE = 0.8  # of the failed volume, from which the mass flowed: blocks are the exception [-]
KEPT_SHARE = 0.125  # of the failed volume in blocks, below which these are crumbs in what was sheared [-]
FLOWED_AMONG_CRUMBS = 0.5  # of the failed volume, from which a mass of crumbs flowed: most of it did [-]
STRAIGHT_WIDTH = 0.025  # distance from a line within which a slip surface is straight, over its length [-]
STRAIGHT_SHARE = 0.7  # of the slip surface's length from which it is a plane; of an arc of 60 degrees it is 0.61 [-]
PLANE_DEPTH = 0.15  # depth over length below which it is one; slides that rotate have 0.15 to 0.33 [-]
TOGETHER = 0.5  # the least-moved quarter of the blocks came at least half as far as the most-moved one [-]
THIN_FOR_LENGTH = 0.05  # mean thickness over length of the slip surface below which a slide is a skin [-]
THIN_FOR_HEIGHT = 0.1  # mean thickness over the height of the ground below which it is one, too [-]
MAIN_BLOCK = 0.75  # share of the area of all blocks from which the largest one is the slide [-]
SPREAD_BLOCKS = 3  # fewest blocks of a spread
SPREAD_RIDGES = 3  # fewest ridges of a spread, lower ground behind and before each
RIDGE_HEIGHT = 0.07  # of a ridge above that ground, over the mean thickness: more than points leave uneven [-]
SPREAD_SLOPE = 8.0  # steepest band below a spread [degrees]

DEFINITIONS = {
    "no_failure": "no soil moves further than the threshold of failure",
    "rotational": f"one mass, not down a plane: the largest block has {MAIN_BLOCK:g} or more of all, or there is none",
    "translational": (
        f"the mass goes down together on a plane: {STRAIGHT_SHARE:g} of the slip surface lies within "
        f"{STRAIGHT_WIDTH:g} of its length from one line, its depth is below {PLANE_DEPTH:g} of its length, and the "
        f"least-moved quarter of the blocks went {TOGETHER:g} as far as the most-moved one, or further"
    ),
    "superficial": (
        f"translational and thin: the mean thickness is below {THIN_FOR_LENGTH:g} of the length or "
        f"{THIN_FOR_HEIGHT:g} of the height of the ground"
    ),
    "earthflow": (
        f"{FLOWED_SHARE:g} or more of the failed mass has a plastic strain of {FLOW_STRAIN:g} or more; "
        f"{FLOWED_AMONG_CRUMBS:g} where less than {KEPT_SHARE:g} of it is in blocks"
    ),
    "retrogressive": f"several slides, one behind the other: the largest block has less than {MAIN_BLOCK:g} of all",
    "spread": (
        f"{SPREAD_BLOCKS} or more blocks and {SPREAD_RIDGES} or more ridges with subsided ground between them, by "
        f"{RIDGE_HEIGHT:g} of the mean thickness, over a band of at most {SPREAD_SLOPE:g} degrees"
    ),
}
ORDER = ("no_failure", "earthflow", "superficial", "translational", "rotational", "spread", "retrogressive")  # of tests
