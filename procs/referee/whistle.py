"""The referee's state machine: turns the sight of each tick into the state of the game.

A stretch of the game is stopped (robots take position), then started (a set piece is taken), then played, until a goal,
a ball out of the field, a foul or a deadlock interrupts it.
"""

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team, team_number
from procs.referee import goals, halves, restarts
from procs.referee.calls import Call
from procs.referee.fouls.book import grave_fouls
from procs.referee.fouls.foul import Foul, Scene
from procs.referee.fouls.set_piece import breach
from procs.referee.line_up import incomplete_team, keeper_is_away, misplaced_robots
from procs.referee.match import Match
from procs.referee.reasons import Reason
from procs.referee.restarts import Restart
from procs.referee.shootout import penalty_scored
from procs.referee.sight import LEAVES, Sight


class Whistle(Match):
    """Leads a match: call `step` once a tick and read the attributes."""

    @property
    def _time_is_over(self) -> bool:
        return not self.shootout and self.time_in_half_s >= halves.length_s(self.half, self.rules)

    @property
    def _is_last_act(self) -> bool:
        """Whether no play follows: the penalty at hand is one that decides the match, or the half ends with it."""
        return bool(self.shootout) or self._time_is_over

    @property
    def _shooter(self) -> Team:
        """Team of the penalty that is to be shot, or whose shot is under way; NONE without one."""
        if self.state is State.PLAY and self._stretch.penalty_rolls:
            return self._stretch.team
        return self.team if self.state is State.PENALTY else Team.NONE

    @property
    def _set_piece_is_late(self) -> bool:
        return self.time_in_state_s >= self.rules.time_of_s(self.state)

    @property
    def _shot_is_over(self) -> bool:
        """Whether a penalty that play would follow cannot be scored any more."""
        return self._stretch.touches.intercepted or (self._set_piece_is_late and not self._stretch.released)

    def step(self, duration_s: float, sight: Sight) -> None:
        """Runs one tick of `duration_s`."""
        self.calls, self.awaited = [], Team.NONE
        self.time_in_state_s += duration_s
        away = self.cards.sent_off
        self.cards.pass_time(duration_s)
        self._stretch.excused |= away - self.cards.sent_off
        touches = self._stretch.touches
        sight = sight.without(self.cards.sent_off, "" if touches.bystander else touches.last)
        if self.over:
            return
        if self.state is State.HALF_TIME:
            if self.rules.automatic and not self.held and self.time_in_state_s >= self.rules.half_time_s:
                self._end_break()
            return
        self.time_in_half_s += duration_s
        if not self.stopped:
            self._ball.remember(sight.ball, self.rules.field)
        if not self.rules.automatic:
            self._follow(duration_s, sight)
        elif self._time_is_over and not self._prolong_for_penalty():
            self._end_in_time(duration_s, sight)
        elif self.stopped:
            self._wait_for_robots(duration_s, sight)
        else:
            self._watch(duration_s, sight)

    def _prolong_for_penalty(self) -> bool:
        """Prolongs the half for a penalty, also for one shot in time that is play by now; returns whether it does."""
        if self.state is State.PLAY and self._shooter:
            self._enter(State.PENALTY, self._shooter, stopped=False)
        return self.state is State.PENALTY

    def _end_in_time(self, duration_s: float, sight: Sight) -> None:
        """Ends the half whose time is over; goals and fouls of this last tick were in time, and a penalty is taken."""
        if not self.stopped:
            scene = self._stretch.watch(duration_s, sight, self.ends, self.rules)
            goal = next((event for event in sight.events if event.kind is Kind.GOAL), None)
            verdict = self._judge(goal, sight) if goal else None
            if verdict and verdict.scorer:
                self._count_fouls(scene)
                self.goal(verdict.scorer)
            elif self._punish(scene, only=State.PENALTY):
                return
        self.end_half()

    def _end_break(self) -> None:
        following = halves.after(self.half, self.score, self.rules)
        if following:
            self.begin_half(following)
        else:
            self.end_match()

    def _follow(self, duration_s: float, sight: Sight) -> None:
        """Follows a game that is led by hand: set pieces become play, except for penalties that decide the match."""
        if self.stopped:
            self._guard_ball(duration_s, sight)
        elif self.state is not State.PLAY and not self.shootout:
            scene = self._stretch.watch(duration_s, sight, self.ends, self.rules)
            if self._is_taken(scene) or self._set_piece_is_late:
                self._play(sight.ball)

    def _guard_ball(self, duration_s: float, sight: Sight) -> None:
        """Has a misplaced ball put back; starts the game if that was to happen with the ball."""
        self._ball.watch(duration_s, sight.ball)
        if self._starting:
            self.start(sight)
        elif self._ball.is_misplaced(sight.ball, sight.robots.values(), self.rules):
            self._ball.put_back()

    def _wait_for_robots(self, duration_s: float, sight: Sight) -> None:
        self._guard_ball(duration_s, sight)
        rules = self.rules
        stoppage_s = rules.kick_off_stoppage_s if self.state is State.KICK_OFF else rules.stoppage_s
        waits = self.held or self._starting or self.time_in_state_s < stoppage_s
        if not self.stopped or waits:
            return
        self.awaited = incomplete_team(sight, self.cards, rules.least_robots)
        if self.awaited:
            return
        longest_s = rules.ends_s if self._changing_ends else rules.positions_s
        had_time = self.time_in_state_s >= stoppage_s + longest_s and self._ball.laid_s >= longest_s
        misplaced = misplaced_robots(self.restart, sight, self.ends, rules)
        ready = not self._ball.rolls and not misplaced and not keeper_is_away(self.restart, sight, rules.field)
        if ready or had_time:
            self.start(sight)

    def _watch(self, duration_s: float, sight: Sight) -> None:
        scene = self._stretch.watch(duration_s, sight, self.ends, self.rules)
        left = next((event for event in sight.events if event.kind in LEAVES), None)
        if self._is_last_act or self._stretch.suffered:
            self._watch_penalty(scene)
        elif left:
            self._stop_for_ball_out(left, scene)
        elif self.state is State.PLAY:
            self._watch_play(scene)
        else:
            self._watch_set_piece(scene)

    def _stop_for_ball_out(self, event: Event, scene: Scene) -> None:
        """Interrupts the game because the ball has left the field, or because of a foul before that.

        A goal that counts stands, in spite of a foul in the same tick.
        """
        verdict = self._judge(event, scene.sight)
        if verdict.scorer:
            self._count_fouls(scene)
            self.goal(verdict.scorer)
        elif self._repeat_after_bystander(scene):
            return
        elif self._punish(scene._replace(lost_by=verdict.restart.team.other)):
            suffered = self._stretch.suffered
            if suffered and not self.stopped:
                self.interrupt(self.restart, suffered.reason, suffered.robot)
            return
        self.interrupt(verdict.restart, verdict.reason)

    def _judge(self, event: Event, sight: Sight) -> goals.Verdict:
        """Returns which set piece follows a ball that has left the field, and which team has scored with it."""
        rules, place, team = self.rules, Point(event.x_m, event.y_m), team_number(event.robot)
        if event.kind is Kind.OUT_SIDE:
            return goals.Verdict(Team.NONE, restarts.after_side_line(place, team, rules))
        if event.kind is Kind.OUT_END:
            return goals.Verdict(Team.NONE, restarts.after_goal_line(place, team, rules, self.ends))
        return goals.judge(event, self._stretch.piece, self._stretch.touches, sight, self.ends, rules)

    def _watch_play(self, scene: Scene) -> None:
        ball = scene.sight.ball
        self._stretch.rolled(ball, self.rules)
        if not self._punish(scene) and self._stretch.deadlocked(scene):
            self.interrupt(restarts.dropped_ball(ball, self.rules), Reason.DEADLOCK)

    def _watch_set_piece(self, scene: Scene) -> None:
        if self._punish(scene) or self._repeat(scene) or self._repeat_after_bystander(scene):
            return
        if self._is_taken(scene):
            self._play(scene.sight.ball)
        elif self._set_piece_is_late:
            if self.state is State.PENALTY and not self._stretch.taken:
                self.interrupt(self._goal_kick(), Reason.NOT_TAKEN)
            else:
                self._play(scene.sight.ball, late=True)

    def _is_taken(self, scene: Scene) -> bool:
        """Returns whether the set piece becomes play: its ball has rolled freely, or a dropped one was touched."""
        rolled = self._stretch.rolled(scene.sight.ball, self.rules)
        return rolled or (self.state is State.DROP_BALL and bool(scene.touches.robots))

    def _watch_penalty(self, scene: Scene) -> None:
        """Watches a penalty that is one shot: one that decides a match, the last act of a half, or one after a foul.

        A foul of the team that shoots makes it a miss. One that is the last act is repeated if a foul that brings a
        penalty itself precedes a miss, any other penalty after any foul of the team that defends.
        """
        if self._repeat(scene) or self._repeat_after_bystander(scene):
            return
        if not self._stretch.taken and any(event.kind in LEAVES for event in scene.sight.events):
            self.interrupt(self.restart)  # a person, a defender, or a robot that takes no part has taken the ball away
            return
        stretch, last = self._stretch, self._is_last_act
        reach_s = self.rules.shot_s if self.shootout else self.rules.penalty_s
        scored = penalty_scored(scene, stretch, self.restart, self.time_in_state_s, reach_s)
        fouls = grave_fouls(scene)
        for foul in fouls:
            self._count_foul(foul)
            if not last or self._after_fouls([foul], scene.sight.ball) == self.restart:
                stretch.suffered = foul
        if any(team_number(foul.robot) is self.team for foul in fouls):
            scored, stretch.suffered = False, None
        elif scored is None and not last and self._shot_is_over:
            scored = False
        suffered = stretch.suffered
        if scored is None:
            return
        if suffered and not scored:
            self.interrupt(self.restart, suffered.reason, suffered.robot)
        elif self.shootout:
            self.end_penalty(scored)
        else:
            self._end_penalty_of_half(scored, fouls, scene.sight.ball)

    def _end_penalty_of_half(self, scored: bool, fouls: list[Foul], ball: Point) -> None:
        """Counts a penalty, and ends the half with it if its time is over; `fouls` are those that made it a miss."""
        team = self.team
        if scored:
            self.goal(team)
        if self._time_is_over:
            self.end_half()
        elif scored:
            self.interrupt(restarts.kick_off(team.other))
        else:
            self._stop_for(fouls, ball)

    def _repeat(self, scene: Scene) -> bool:
        """Has the set piece repeated after a breach, `repeats` times at most; returns whether it does.

        A further breach is only counted as a foul, once. A penalty is repeated as often as defenders play its ball: the
        cards for that end it.
        """
        stretch = self._stretch
        foul = breach(scene, self.restart, stretch.excused, stretch.keeper, stretch.released)
        played = self.state is State.PENALTY and foul is not None and foul.reason is Reason.EARLY_TOUCH
        if foul is None or (stretch.breached and not played):
            return False
        self._count_foul(foul)
        stretch.breached = True
        return self._repeat_for(foul.reason, foul.robot, always=played)

    def _repeat_after_bystander(self, scene: Scene) -> bool:
        """Has the set piece repeated as often if a robot that takes no part moved its ball before any other."""
        touches = scene.touches
        untouched = self.state is not State.PLAY and not touches.robots
        if not (untouched and touches.bystander and self._stretch.rolled(scene.sight.ball, self.rules)):
            return False
        return self._repeat_for(Reason.EARLY_TOUCH, touches.bystander)

    def _repeat_for(self, reason: Reason, robot: str, always: bool = False) -> bool:
        """Has the set piece repeated because of a robot, `repeats` times at most; returns whether it does."""
        if self._repeats >= self.rules.repeats and not always:
            return False
        repeats = self._repeats + 1
        self.interrupt(self.restart, reason, robot)
        self._repeats = repeats
        return True

    def _punish(self, scene: Scene, only: State | None = None) -> bool:
        """Counts the fouls of a tick and interrupts the game for the set piece that they bring; returns whether it did.

        `only` is the one set piece for which the game is interrupted; None: any.
        """
        punished = self._count_fouls(scene)
        if not punished:
            return False
        if len(punished) == 1 and self._shooter is team_number(punished[0].robot).other:
            self._suffer(punished[0])
            return True
        if only not in (None, self._after_fouls(punished, scene.sight.ball).state):
            return False
        self._stop_for(punished, scene.sight.ball)
        return True

    def _count_fouls(self, scene: Scene) -> list[Foul]:
        """Counts the fouls of a tick, and returns those that are punished now."""
        committed, punished = self._stretch.fouls(scene, in_play=self.state is State.PLAY)
        for foul in committed:
            self._count_foul(foul)
        return punished

    def _suffer(self, foul: Foul) -> None:
        """Repeats a penalty during which its defenders commit a foul: at once, or if the shot at hand is no goal."""
        if self.state is State.PENALTY and not self._stretch.taken:
            self.interrupt(self.restart, foul.reason, foul.robot)
            return
        self._stretch.suffered = foul
        if self.state is State.PLAY:
            self._enter(State.PENALTY, self._shooter, stopped=False)

    def _stop_for(self, fouls: list[Foul], ball: Point) -> None:
        """Interrupts the game for the set piece that fouls bring."""
        self.interrupt(self._after_fouls(fouls, ball), fouls[0].reason, fouls[0].robot if len(fouls) == 1 else "")

    def _after_fouls(self, fouls: list[Foul], ball: Point) -> Restart:
        """Returns the free kick or the penalty that a foul brings; fouls of both teams bring a dropped ball."""
        foul, rules = fouls[0], self.rules
        offender = team_number(foul.robot)
        if len(fouls) > 1:
            return restarts.dropped_ball(ball, rules)
        if foul.direct and rules.field.in_penalty_area(*foul.place, self.ends.side_of(offender)):
            return restarts.penalty(offender.other, rules, self.ends)
        return restarts.after_foul(foul.place, offender, rules)

    def _count_foul(self, foul: Foul) -> None:
        """Counts a foul against its robot, and shows the card that it brings."""
        card = self.cards.foul(foul.robot, self.rules)
        if card:
            self.calls.append(Call(self.state, team_number(foul.robot), robot=foul.robot, card=card))

    def _goal_kick(self) -> Restart:
        return restarts.goal_kick(self.team.other, 1.0, self.rules, self.ends)

    def _play(self, ball: Point, late: bool = False) -> None:
        self._stretch.begin_play(ball, self.team if late else Team.NONE)
        self._enter(State.PLAY, Team.NONE, stopped=False)
