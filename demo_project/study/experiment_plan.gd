extends RefCounted
## What one participant does, in order: from the participant's number alone, so that a broken-off session can go on.

enum Kind { INSTRUCTION, PRACTICE, TRIAL, RATINGS, BREAK, END }

const CONDITIONS: PackedStringArray = ["forces_on", "forces_off", "mouse", "mouse_auto"]
## Williams' design for four conditions: each comes once in each place, and once after each other one.
const ORDERS: Array[Array] = [[0, 1, 3, 2], [1, 2, 0, 3], [2, 3, 1, 0], [3, 0, 2, 1]]
## Layouts of the practice and of the trials: the same in all conditions.
const PRACTICE_SEED := 1000
const FIRST_SEED := 1


## One thing to do.
class Step:
	var kind := Kind.INSTRUCTION
	var task := ""
	var condition := ""
	## From 1; 0 for a practice.
	var trial := 0
	var seed_number := 0


## participant: 1 and up. trials: counted ones per task and condition.
static func make(
	participant: int, trials: int, tasks: PackedStringArray
) -> Array[Step]:
	var steps: Array[Step] = []
	var order: Array = ORDERS[(participant - 1) % ORDERS.size()]
	for place in order.size():
		var index: int = order[place]
		var condition := CONDITIONS[index]
		for turn in tasks.size():
			# Tasks go round with the participants, too.
			@warning_ignore("integer_division")
			var round_of := (participant - 1) / ORDERS.size()
			var task := tasks[(turn + round_of) % tasks.size()]
			steps.append(_step(Kind.INSTRUCTION, task, condition))
			steps.append(_step(Kind.PRACTICE, task, condition, 0, PRACTICE_SEED))
			for trial in trials:
				steps.append(_step(Kind.TRIAL, task, condition, trial + 1, FIRST_SEED + trial))
			steps.append(_step(Kind.RATINGS, task, condition))
		if place < order.size() - 1:
			steps.append(_step(Kind.BREAK, "", condition))
	steps.append(_step(Kind.END, "", ""))
	return steps


static func _step(
	kind: Kind, task: String, condition: String, trial: int = 0, seed_number: int = 0
) -> Step:
	var step := Step.new()
	step.kind = kind
	step.task = task
	step.condition = condition
	step.trial = trial
	step.seed_number = seed_number
	return step
