(** The geometry of a packing to first order: displacements are sums of radii along diagonals. That centres and
    contact directions along n⁺ are differentiable follows, and what Eqs. 1-4 rest on. *)

From Coq Require Import ZArith Reals Lia Lra.
From ForceDiffusion Require Import Model Sums FirstOrder Lattice.

Open Scope R_scope.

Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

(** ** Line sums *)

(** n⁺·δx and n⁻·δx to first order, over ε: sums of ρ down one diagonal (Eq. 3); 0 on the base. *)
Definition along_plus (rho : radii) (i j : Z) : R :=
  if (j =? 0)%Z then 0
  else rho (i - j)%Z 0%Z + rho i j + 2 * Sum 1 (j - 1) (fun m => rho (i - j + m)%Z m).
(** What is at the sites, seen in a mirror: i becomes -i, n⁺ and n⁻ change places. *)
Definition mirrored {A} (at_sites : Z -> Z -> A) : Z -> Z -> A := fun i j => at_sites (- i)%Z j.
Definition along_minus (rho : radii) (i j : Z) : R := along_plus (mirrored rho) (- i) j.

Lemma along_plus_step rho i j : (1 <= j)%Z ->
  along_plus rho i j = along_plus rho (i - 1) (j - 1) + rho i j + rho (i - 1)%Z (j - 1)%Z.
Proof.
  intros Hj. unfold along_plus. replace (j =? 0)%Z with false by lia.
  destruct (j - 1 =? 0)%Z eqn:E.
  - replace j with 1%Z by lia. rewrite Sum_empty by lia.
    replace (i - 1)%Z with (i - 1 + 0)%Z at 2 by lia. cbn. ring_simplify.
    replace (i - 1 + 0)%Z with (i - 1)%Z by lia. ring.
  - rewrite (Sum_last 1 (j - 1)) by lia.
    replace (i - 1 - (j - 1))%Z with (i - j)%Z by lia.
    replace (i - j + (j - 1))%Z with (i - 1)%Z by lia. ring.
Qed.

Lemma along_minus_step rho i j : (1 <= j)%Z ->
  along_minus rho i j = along_minus rho (i + 1) (j - 1) + rho i j + rho (i + 1)%Z (j - 1)%Z.
Proof. intros Hj. unfold along_minus. rewrite along_plus_step by lia. unfold mirrored. same_sites. Qed.

(** ** Positions *)

(** A bead on two others of its height: which of the two circles' intersections lies above. *)
Lemma apex (a h c s x y : R) : 0 < s ->
  (x - (a - c)) ^ 2 + (y - h) ^ 2 = c ^ 2 + s ^ 2 ->
  (x - (a + c)) ^ 2 + (y - h) ^ 2 = c ^ 2 + s ^ 2 -> c <> 0 -> h < y -> x = a /\ y = h + s.
Proof.
  intros Hs H1 H2 Hc Hy.
  assert (Hx : x = a) by (apply (Rmult_eq_reg_l c); [lra|exact Hc]).
  subst x. split; [reflexivity|].
  assert (P : (y - h - s) * (y - h + s) = 0) by lra.
  apply Rmult_integral in P. destruct P; lra.
Qed.

Section Packing.
  Context (G : lattice) (M : Z) (rho : radii) (X : centres) (P : packing G M rho X).
  Local Notation r := (r G).
  Local Notation n_x := (n_x G).
  Local Notation n_y := (n_y G).

  Theorem ordered_position j : (0 <= j)%Z -> forall i, bead M i j ->
    X i j 0 = Vector (2 * IZR i * r * n_x) (2 * IZR j * r * n_y).
  Proof.
    intros Hj. pattern j. apply (up_from _ 0); [| |exact Hj]; clear j Hj.
    - intros i Hi. rewrite (base_is_fixed _ _ _ _ P) by exact Hi. f_equal. ring.
    - intros j Hj IH i Hi.
      pose proof (near_zero _ (touches_left _ _ _ _ P i (j + 1) Hi ltac:(lia))) as L.
      pose proof (near_zero _ (touches_right _ _ _ _ P i (j + 1) Hi ltac:(lia))) as R.
      pose proof (above_supports _ _ _ _ P i (j + 1) Hi ltac:(lia)) as A.
      steps_back in *.
      rewrite IH in L by site. rewrite IH in R by site. rewrite IH in A by site.
      destruct (X i (j + 1)%Z 0) as [x y].
      unfold dot, minus, add, scale, delta_r in *. cbn [x_of y_of] in *.
      rewrite minus_IZR in *. rewrite plus_IZR in *.
      destruct (apex (2 * IZR i * r * n_x) (2 * IZR j * r * n_y) (2 * r * n_x) (2 * r * n_y) x y)
        as [-> ->].
      + pose proof (r_pos G). pose proof (n_y_pos G).
        apply Rmult_lt_0_compat; [lra|assumption].
      + etransitivity; [|etransitivity; [exact L|]]; ring [(n_y_squared G)].
      + etransitivity; [|etransitivity; [exact R|]]; ring [(n_y_squared G)].
      + pose proof (r_pos G). pose proof (n_x_pos G).
        apply Rgt_not_eq. apply Rmult_lt_0_compat; [lra|assumption].
      + exact A.
      + f_equal; ring.
  Qed.

  (** The derivative of a contact's constraint: 2 (u·u′) = 2 · 2r · (sum of both ρ). *)
  Lemma touch_slope i j k l xi yi xk yk dxi dyi dxk dyk :
    touch G rho X i j k l ->
    expands (fun e => x_of (X i j e)) xi dxi -> expands (fun e => y_of (X i j e)) yi dyi ->
    expands (fun e => x_of (X k l e)) xk dxk -> expands (fun e => y_of (X k l e)) yk dyk ->
    (xi - xk) * (dxi - dxk) + (yi - yk) * (dyi - dyk) = 2 * r * (rho i j + rho k l).
  Proof.
    intros T Hxi Hyi Hxk Hyk.
    pose proof (expands_minus _ _ _ _ _ _ Hxi Hxk) as Dx.
    pose proof (expands_minus _ _ _ _ _ _ Hyi Hyk) as Dy.
    pose proof (expands_plus _ _ _ _ _ _ (expands_mult _ _ _ _ _ _ Dx Dx)
      (expands_mult _ _ _ _ _ _ Dy Dy)) as L.
    assert (R : expands (fun e => ((r + delta_r rho i j e) + (r + delta_r rho k l e)) ^ 2)
      ((r + 0 * rho i j + (r + 0 * rho k l)) ^ 2) (4 * r * (rho i j + rho k l))).
    { eapply expands_to; [apply expands_pow2; unfold delta_r;
        expand_with ltac:(fun _ => fail)|reflexivity|ring]. }
    assert (N : near (fun e =>
      (x_of (X i j e) - x_of (X k l e)) * (x_of (X i j e) - x_of (X k l e)) +
      (y_of (X i j e) - y_of (X k l e)) * (y_of (X i j e) - y_of (X k l e)) =
      ((r + delta_r rho i j e) + (r + delta_r rho k l e)) ^ 2)).
    { eapply near_then; [exact T|]. cbv beta. intros e E. rewrite <- E.
      unfold dot, minus, add, scale. cbn. ring. }
    destruct (expands_unique _ _ _ _ _ (expands_near _ _ _ _ L N) R) as [_ E]. lra.
  Qed.

  (** A bead rests where its supports' circles meet; so it moves as smoothly as they do. *)
  Lemma rests_where_they_meet i j ax ay ax' ay' bx' by' : bead M i j -> (1 <= j)%Z ->
    y_of (X i j 0) = ay + 2 * r * n_y -> x_of (X i j 0) = ax + 2 * r * n_x ->
    expands (fun e => x_of (X (i - 1)%Z (j - 1)%Z e)) ax ax' ->
    expands (fun e => y_of (X (i - 1)%Z (j - 1)%Z e)) ay ay' ->
    expands (fun e => x_of (X (i + 1)%Z (j - 1)%Z e)) (ax + 4 * r * n_x) bx' ->
    expands (fun e => y_of (X (i + 1)%Z (j - 1)%Z e)) ay by' ->
    (exists d, expands (fun e => x_of (X i j e)) (ax + 2 * r * n_x) d) /\
    (exists d, expands (fun e => y_of (X i j e)) (ay + 2 * r * n_y) d).
  Proof.
    intros H Hj Ey Ex Ax Ay Bx By.
    pose proof (r_pos G) as Hr. pose proof (n_x_pos G) as Hx. pose proof (n_y_pos G) as Hy.
    assert (Pair : forall k l, expands (fun e => (r + delta_r rho i j e) + (r + delta_r rho k l e))
      (2 * r) (rho i j + rho k l)).
    { intros k l. unfold delta_r. eapply expands_to; [expand_with ltac:(fun _ => fail)|ring|ring]. }
    destruct (meeting_expands G _ _ _ _ _ _ _ _ _ _ _ _ Ax Ay Bx By (Pair (i - 1)%Z (j - 1)%Z)
      (Pair (i + 1)%Z (j - 1)%Z)) as [[dx Dx] [[dy Dy] N]].
    destruct (continuous _ _ _ _ P i j H) as [Cx Cy].
    pose proof (expands_continuous _ _ _ Ax) as CAx. pose proof (expands_continuous _ _ _ Ay) as CAy.
    pose proof (expands_continuous _ _ _ Bx) as CBx. pose proof (expands_continuous _ _ _ By) as CBy.
    assert (S : near (fun e => 0 <
      (x_of (X (i + 1)%Z (j - 1)%Z e) - x_of (X (i - 1)%Z (j - 1)%Z e))
        * (y_of (X i j e) - y_of (X (i - 1)%Z (j - 1)%Z e))
      - (y_of (X (i + 1)%Z (j - 1)%Z e) - y_of (X (i - 1)%Z (j - 1)%Z e))
        * (x_of (X i j e) - x_of (X (i - 1)%Z (j - 1)%Z e)))).
    { apply continuous_near_positive.
      - apply continuity_pt_minus; apply continuity_pt_mult; apply continuity_pt_minus; assumption.
      - destruct Ax as [-> _], Ay as [-> _], Bx as [-> _], By as [-> _]. rewrite Ex, Ey.
        replace (_ - _) with (8 * (r * n_x) * (r * n_y)) by ring.
        repeat apply Rmult_lt_0_compat; lra. }
    assert (E : near (fun e => meeting (X (i - 1)%Z (j - 1)%Z e) (X (i + 1)%Z (j - 1)%Z e)
      ((r + delta_r rho i j e) + (r + delta_r rho (i - 1) (j - 1) e))
      ((r + delta_r rho i j e) + (r + delta_r rho (i + 1) (j - 1) e)) = X i j e)).
    { eapply near_then; [exact (near_both _ _ (near_both _ _ N S) (near_both _ _
        (touches_left _ _ _ _ P i j H Hj) (touches_right _ _ _ _ P i j H Hj)))|].
      cbv beta. intros e [[[N1 _] S1] [T1 T2]]. symmetry. apply meeting_unique; try assumption.
      unfold minus, add, scale. cbn [x_of y_of]. lra. }
    split.
    - exists dx. eapply expands_near; [exact Dx|]. eapply near_then; [exact E|]. cbv beta.
      intros e ->. reflexivity.
    - exists dy. eapply expands_near; [exact Dy|]. eapply near_then; [exact E|]. cbv beta.
      intros e ->. reflexivity.
  Qed.

  (** Value and slope of a centre, in Cartesian components of c⁺ b⁺ + c⁻ b⁻. *)
  Theorem centre_expands j : (0 <= j)%Z -> forall i, bead M i j ->
    expands (fun e => x_of (X i j e)) (2 * IZR i * r * n_x)
      ((along_plus rho i j - along_minus rho i j) / (2 * n_x)) /\
    expands (fun e => y_of (X i j e)) (2 * IZR j * r * n_y)
      ((along_plus rho i j + along_minus rho i j) / (2 * n_y)).
  Proof.
    pose proof (r_pos G) as Hr. pose proof (n_x_pos G) as Hx. pose proof (n_y_pos G) as Hy.
    intros Hj. pattern j. apply (up_from _ 0); [| |exact Hj]; clear j Hj.
    - intros i Hi. unfold along_minus, along_plus. cbn [Z.eqb].
      split; (eapply expands_near; [eapply expands_to; [apply expands_const|reflexivity|field; lra]|]);
        apply near_always; intros e; rewrite (base_is_fixed _ _ _ _ P) by exact Hi; cbn; ring.
    - intros j Hj IH i Hi.
      destruct (IH (i - 1)%Z ltac:(site)) as [Lx Ly]. destruct (IH (i + 1)%Z ltac:(site)) as [Rx Ry].
      pose proof (ordered_position (j + 1) ltac:(lia) i Hi) as E.
      assert (D : (exists d, expands (fun e => x_of (X i (j + 1)%Z e)) (2 * IZR i * r * n_x) d) /\
        (exists d, expands (fun e => y_of (X i (j + 1)%Z e)) (2 * IZR (j + 1) * r * n_y) d)).
      { pose proof (rests_where_they_meet i (j + 1)) as W.
        steps_back in W. rewrite E in W. cbn [x_of y_of] in W.
        rewrite minus_IZR in Lx. rewrite plus_IZR in Rx. rewrite plus_IZR in W. rewrite plus_IZR.
        replace (2 * (IZR i + 1) * r * n_x) with (2 * (IZR i - 1) * r * n_x + 4 * r * n_x) in Rx by ring.
        destruct (W (2 * (IZR i - 1) * r * n_x) (2 * IZR j * r * n_y) _ _ _ _ Hi ltac:(lia)
          ltac:(ring) ltac:(ring) Lx Ly Rx Ry) as [[dx Dx] [dy Dy]].
        split; eexists; (eapply expands_to; [eassumption|ring|reflexivity]). }
      destruct D as [[dx Ex] [dy Ey]].
      pose proof (touches_left _ _ _ _ P i (j + 1) Hi ltac:(lia)) as TL.
      pose proof (touches_right _ _ _ _ P i (j + 1) Hi ltac:(lia)) as TR.
      steps_back in *.
      pose proof (touch_slope _ _ _ _ _ _ _ _ _ _ _ _ TL Ex Ey Lx Ly) as SL.
      pose proof (touch_slope _ _ _ _ _ _ _ _ _ _ _ _ TR Ex Ey Rx Ry) as SR.
      pose proof (along_plus_step rho i (j + 1) ltac:(lia)) as CP.
      pose proof (along_minus_step rho i (j + 1) ltac:(lia)) as CM.
      steps_back in *.
      rewrite minus_IZR, plus_IZR in SL. rewrite !plus_IZR in SR.
      assert (KP : n_x * dx + n_y * dy = along_plus rho i (j + 1)).
      { apply (Rmult_eq_reg_l (2 * r)); [|lra]. rewrite CP.
        transitivity (2 * r * along_plus rho (i - 1) j +
          2 * r * (rho i (j + 1)%Z + rho (i - 1)%Z j)); [rewrite <- SL; field; lra|ring]. }
      assert (KM : - n_x * dx + n_y * dy = along_minus rho i (j + 1)).
      { apply (Rmult_eq_reg_l (2 * r)); [|lra]. rewrite CM.
        transitivity (2 * r * along_minus rho (i + 1) j +
          2 * r * (rho i (j + 1)%Z + rho (i + 1)%Z j)); [rewrite <- SR; field; lra|ring]. }
      rewrite <- KP, <- KM.
      split; (eapply expands_to; [eassumption|reflexivity|field; lra]).
  Qed.

  (** Displacements: the same slopes, on values 0. *)
  Lemma delta_x_expands i j : bead M i j ->
    expands (fun e => x_of (delta_x X i j e)) 0 ((along_plus rho i j - along_minus rho i j) / (2 * n_x)) /\
    expands (fun e => y_of (delta_x X i j e)) 0 ((along_plus rho i j + along_minus rho i j) / (2 * n_y)).
  Proof.
    intros H. destruct (centre_expands j ltac:(site) i H) as [Dx Dy].
    pose proof Dx as [Ex _]. pose proof Dy as [Ey _]. cbv beta in Ex, Ey.
    unfold delta_x, minus, add, scale. cbn [x_of y_of]. rewrite Ex, Ey.
    split; (eapply expands_to; [apply expands_plus; [eassumption|apply expands_const]|ring|ring]).
  Qed.

  (** ** Directions *)

  (** n⁻·δn⁺ to first order, over ε; the other component is 0. *)
  Definition tilt_plus (i j : Z) : R :=
    (along_minus rho (i + 1) (j + 1) - along_minus rho i j
      - phi G * (rho i j + rho (i + 1)%Z (j + 1)%Z)) / (2 * r).

  (** The centres of a contact are exactly the sum of the radii apart. *)
  Lemma distance i j k l : touch G rho X k l i j -> near (fun e =>
    norm (minus (X k l e) (X i j e)) = 2 * r + e * (rho i j + rho k l)).
  Proof.
    intros T.
    assert (R : expands (fun e => 2 * r + e * (rho i j + rho k l)) (2 * r)
      (rho i j + rho k l)).
    { eapply expands_to; [expand_with ltac:(fun _ => fail)|ring|ring]. }
    pose proof (r_pos G) as Hr.
    eapply near_then; [exact (near_both _ _ T (expands_near_positive _ _ _ R ltac:(lra)))|].
    cbv beta. intros e [E Hp]. unfold norm. rewrite E. unfold delta_r.
    replace ((r + e * rho k l + (r + e * rho i j)) ^ 2)
      with ((2 * r + e * (rho i j + rho k l)) * (2 * r + e * (rho i j + rho k l))) by ring.
    apply sqrt_square. lra.
  Qed.

  Lemma N_plus_expands i j : contact M i j ->
    expands (fun e => x_of (N_plus X i j e)) n_x (- tilt_plus i j / (2 * n_x)) /\
    expands (fun e => y_of (N_plus X i j e)) n_y (tilt_plus i j / (2 * n_y)).
  Proof.
    intros H. pose proof (r_pos G) as Hr. pose proof (n_x_pos G). pose proof (n_y_pos G).
    assert (T : touch G rho X (i + 1) (j + 1) i j).
    { pose proof (touches_left _ _ _ _ P (i + 1) (j + 1) ltac:(site) ltac:(site)) as T.
      steps_back in T.
      exact T. }
    apply distance in T.
    destruct (centre_expands j ltac:(site) i ltac:(site)) as [Ax Ay].
    destruct (centre_expands (j + 1) ltac:(site) (i + 1) ltac:(site)) as [Bx By].
    pose proof (along_plus_step rho (i + 1) (j + 1) ltac:(site)) as C.
    steps_back in C.
    assert (D : expands (fun e => 2 * r + e * (rho i j + rho (i + 1)%Z (j + 1)%Z)) (2 * r)
      (rho i j + rho (i + 1)%Z (j + 1)%Z)).
    { eapply expands_to; [expand_with ltac:(fun _ => fail)|ring|ring]. }
    rewrite plus_IZR in Bx, By. unfold tilt_plus.
    assert (F : forall x : vector -> R, x = x_of \/ x = y_of -> near (fun e =>
      (x (X (i + 1)%Z (j + 1)%Z e) - x (X i j e)) /
        (2 * r + e * (rho i j + rho (i + 1)%Z (j + 1)%Z)) = x (N_plus X i j e))).
    { intros x Hx. eapply near_then; [exact T|]. cbv beta. intros e E.
      unfold N_plus, direction. rewrite E. unfold scale, minus, add.
      destruct Hx as [-> | ->]; cbn; unfold Rdiv; ring. }
    split; (eapply expands_near; [|apply F; auto]); (eapply expands_to;
      [apply expands_div; [|apply expands_minus|exact D];
        [|first [exact Bx|exact By]|first [exact Ax|exact Ay]]; lra
      |field; lra
      |rewrite C, phi_is]).
    - rewrite n_y_squared. field. lra.
    - replace (n_x * n_x) with (1 - n_y * n_y) by ring [(n_y_squared G)]. field. lra.
  Qed.

  Lemma delta_n_plus_expands i j : contact M i j ->
    expands (fun e => x_of (delta_n_plus G X i j e)) 0 (- tilt_plus i j / (2 * n_x)) /\
    expands (fun e => y_of (delta_n_plus G X i j e)) 0 (tilt_plus i j / (2 * n_y)).
  Proof.
    intros H. destruct (N_plus_expands i j H). unfold delta_n_plus, n_plus, minus, add, scale. cbn [x_of y_of].
    split; (eapply expands_to; [apply expands_plus; [eassumption|apply expands_const]|ring|ring]).
  Qed.
End Packing.

Lemma delta_r_expands rho i j : expands (delta_r rho i j) 0 (rho i j).
Proof. unfold delta_r. eapply expands_to; [expand_with ltac:(fun _ => fail)|ring|ring]. Qed.

(** The tilt in the radii, as Eq. 4 prints it. *)
Lemma tilt_plus_is G rho i j : (0 <= j)%Z ->
  2 * r G * tilt_plus G rho i j =
  (1 - phi G) * (rho i j + rho (i + 1)%Z (j + 1)%Z) + (rho (i + j + 2)%Z 0%Z - rho (i + j)%Z 0%Z
    + 2 * (Sum 1 j (fun m => rho (i + j - m + 2)%Z m) - Sum 1 j (fun m => rho (i + j - m)%Z m))).
Proof.
  intros Hj. pose proof (r_pos G). unfold tilt_plus, along_minus, along_plus, mirrored.
  replace (j + 1 =? 0)%Z with false by lia. destruct (j =? 0)%Z eqn:E.
  - assert (j = 0%Z) as -> by lia. rewrite !Sum_empty by lia. normal_form. field. lra.
  - rewrite (Sum_last 1 j (fun m => rho (i + j - m)%Z m)) by lia. normal_form. field. lra.
Qed.
