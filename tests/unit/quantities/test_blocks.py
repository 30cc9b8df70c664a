import numpy as np
import pytest

from rfmpm.quantities.blocks import block_count

# Pairs of points in neighbouring cells: 0.5 m2 each, the smallest block.
CHAIN = [(8.25, 0.5), (8.75, 0.5), (9.25, 0.5), (9.75, 0.5), (10.25, 0.5), (10.75, 0.5)]


def test_a_sheared_zone_parts_two_blocks(came_to):
    assert block_count(came_to(*CHAIN)) == 1
    assert block_count(came_to(*CHAIN, plastic_strain=[0.0, 0.0, 0.5, 0.5, 0.0, 0.0])) == 2


@pytest.mark.parametrize(("strain", "count"), [(0.19, 1), (0.2, 0), (0.21, 0)])
def test_a_block_has_less_plastic_strain_than_the_setting(came_to, strain, count):
    assert block_count(came_to(*CHAIN, plastic_strain=strain)) == count


@pytest.mark.parametrize(("area", "count"), [(0.5, 2), (0.51, 1), (1.1, 0)])
def test_a_block_has_at_least_the_smallest_area(came_to, area, count):
    # An intact part of 0.5 m2 and one of 1 m2.
    places = [*CHAIN, (11.25, 0.5), (11.75, 0.5)]
    strain = [0.0, 0.0, 0.5, 0.5, 0.0, 0.0, 0.0, 0.0]
    assert block_count(came_to(*places, plastic_strain=strain, block_minimum_area=area)) == count


def test_area_is_the_one_at_the_start(came_to):
    assert block_count(came_to(*CHAIN[:2], volume=9.0, volume_initial=0.2)) == 0


def test_blocks_that_share_a_corner_are_two(came_to):
    assert block_count(came_to((8.25, 0.5), (8.75, 0.5), (9.25, 1.5), (9.75, 1.5))) == 2


def test_what_stands_is_no_block_and_links_none(state):
    moved = [*CHAIN[:2], *CHAIN[4:]]
    toy = state([(2.0, 1.0)] * 4 + CHAIN[2:4], moved + CHAIN[2:4])
    assert block_count(toy) == 2


def test_nothing_failed(body):
    assert block_count(body()) == 0


def test_everything_failed(body):
    assert block_count(body(lambda x, y: (x + 3.0, y))) == 1
    assert block_count(body(lambda x, y: (x + 3.0, y), plastic_strain=np.inf)) == 0
